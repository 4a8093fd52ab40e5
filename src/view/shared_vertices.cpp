#include "view/shared_vertices.hpp"

#include <map>

namespace sunfleck {

namespace {

std::vector<Piece> pieces_of(const Plant& plant) {
  std::vector<Piece> pieces;
  std::vector<std::vector<std::uint32_t>> row(plant.meshes.size());  // per mesh and vertex: its row in the piece at hand
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) row[m].assign(plant.meshes[m].vertices.size(), no_parent);
  for (const auto& shape : plant.shapes) {
    Piece& piece = pieces.emplace_back();
    const Mesh& mesh = plant.meshes[shape.mesh];
    auto& rows = row[shape.mesh];
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      auto triangle = mesh.triangles[shape.first_triangle + t];
      for (auto& v : triangle) {
        if (rows[v] == no_parent) {
          rows[v] = static_cast<std::uint32_t>(piece.vertices.size());
          piece.vertices.push_back(v);
        }
        v = rows[v];
      }
      piece.triangles.push_back(triangle);
    }
    for (const auto v : piece.vertices) rows[v] = no_parent;
  }
  return pieces;
}

}  // namespace

SharedVertices::SharedVertices(const ResultGeometry& geometry) {
  std::map<const Plant*, std::size_t> known;
  for (const auto& entry : geometry.plants) {
    const auto [place, added] = known.try_emplace(entry.plant.get(), models_.size());
    if (added) models_.push_back(pieces_of(*entry.plant));
    model_of_.push_back(place->second);
  }
  for (const auto& copy : geometry.copies)
    for (const auto& piece : pieces(copy.plant)) vertex_count_ += piece.vertices.size();
  vertex_count_ += geometry.ground.vertices.size();
}

}  // namespace sunfleck
