// Meshes of placed pieces whose facets share vertices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/result/result_geometry.hpp>

namespace sunfleck {

/// A piece of mesh (a shape) with only the vertices that it uses.
struct Piece {
  std::vector<std::uint32_t> vertices;                  ///< rows of the mesh's vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< rows of `vertices`
};

/// Per distinct plant its pieces, one a shape; made once however often the plant stands there.
class SharedVertices {
 public:
  explicit SharedVertices(const ResultGeometry& geometry);
  const std::vector<Piece>& pieces(std::size_t plant) const { return models_[model_of_[plant]]; }
  /// Vertices of the whole scene, ground included.
  std::size_t vertex_count() const { return vertex_count_; }

 private:
  std::vector<std::vector<Piece>> models_;
  std::vector<std::size_t> model_of_;  ///< per row of ResultGeometry::plants
  std::size_t vertex_count_ = 0;
};

}  // namespace sunfleck
