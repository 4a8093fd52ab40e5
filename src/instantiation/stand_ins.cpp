#include "instantiation/stand_ins.hpp"

#include <map>
#include <memory>

namespace sunfleck {

namespace {

/// The shapes of some structures of a plant as a plant of its own: one organ after the other, facets in their order, frame of the plant.
PlantEntry part_of(const PlantEntry& entry, const std::vector<bool>& kept) {
  const Plant& from = *entry.plant;
  auto out = std::make_shared<Plant>();
  out->name = from.name;
  out->file = from.file;
  out->types = from.types;
  out->materials = from.materials;
  std::map<std::uint32_t, std::uint32_t> structure_of, mesh_of;
  out->structures.push_back(from.structures.front());
  out->structures.front().attributes.clear();
  PlantEntry piece;
  piece.name = entry.name;
  for (std::size_t s = 0; s < from.shapes.size(); ++s) {
    Shape shape = from.shapes[s];
    if (!kept[shape.structure]) continue;
    const auto [structure, new_structure] = structure_of.emplace(shape.structure, static_cast<std::uint32_t>(out->structures.size()));
    if (new_structure) {
      out->structures.push_back(from.structures[shape.structure]);
      out->structures.back().parent = 0;
      out->structures.back().attributes.clear();
    }
    const auto [mesh, new_mesh] = mesh_of.emplace(shape.mesh, static_cast<std::uint32_t>(out->meshes.size()));
    if (new_mesh) out->meshes.push_back(from.meshes[shape.mesh]);
    shape.structure = structure->second;
    shape.mesh = mesh->second;
    out->shapes.push_back(shape);
    piece.shape_optics.push_back(entry.shape_optics[s]);
  }
  piece.plant = std::move(out);
  return piece;
}

/// Classes of all that is large hold trunks and limbs alike: a limb does not stand in for a trunk.
bool close_in_size(const ClassMember& m, const OriginalClass& of) {
  const double ratio = m.area_m2 / of.members[of.representative].area_m2;
  return ratio > 0.25 && ratio < 4.0;
}

std::vector<bool> below(const Plant& plant, std::uint32_t root) {
  std::vector<bool> kept(plant.structures.size(), false);
  kept[root] = true;
  for (std::size_t s = root + 1; s < kept.size(); ++s)
    if (const auto parent = plant.structures[s].parent; parent != no_parent) kept[s] = kept[s] || kept[parent];
  return kept;
}

}  // namespace

Approximation approximate(const Scene& scene, const PlacedScene& placed, const Classification& classes) {
  Approximation out;
  out.of_plant.resize(scene.plants.size());
  out.piece_of.resize(scene.plants.size());
  if (scene.periodic) return out;
  std::vector<std::uint32_t> copies(scene.plants.size(), 0);
  for (std::size_t c = 0; c < placed.all_copies(); ++c) ++copies[placed.plant_of(c)];
  std::vector<std::map<std::uint32_t, std::pair<std::uint32_t, const ClassMember*>>> member(scene.plants.size());  // by structure
  for (std::uint32_t k = 0; k < classes.classes.size(); ++k)
    if (classes.classes[k].likeness == Likeness::policy)
      for (const auto& m : classes.classes[k].members)
        if (!m.structure.is_group && close_in_size(m, classes.classes[k]))
          member[m.structure.index].emplace(m.structure.structure, std::pair{k, &m});
  std::map<std::uint32_t, std::uint32_t> piece_of_class;
  for (std::uint32_t p = 0; p < scene.plants.size(); ++p) {
    if (copies[p] != 1 || scene.plants[p].policy_file.empty() || member[p].empty()) continue;
    const Plant& plant = *scene.plants[p].plant;
    std::vector<bool> closed(plant.structures.size(), false);
    std::vector<std::uint32_t> piece_of(plant.structures.size(), no_parent);
    for (std::uint32_t s = 0; s < plant.structures.size(); ++s) {
      const auto parent = plant.structures[s].parent;
      closed[s] = parent != no_parent && closed[parent];
      if (closed[s]) {
        piece_of[s] = piece_of[parent];
        continue;
      }
      const auto at = member[p].find(s);
      if (at == member[p].end()) continue;
      closed[s] = true;
      const auto [k, m] = at->second;
      const auto [piece, added] = piece_of_class.emplace(k, static_cast<std::uint32_t>(out.pieces.size()));
      if (added) {
        const auto& original = classes.classes[k];
        const auto& representative = original.members[original.representative].structure;
        const auto& entry = scene.plants[representative.index];
        out.pieces.push_back(part_of(entry, below(*entry.plant, representative.structure)));
      }
      piece_of[s] = static_cast<std::uint32_t>(out.of_plant[p].size());
      out.of_plant[p].push_back({piece->second, m->from_representative});
      ++out.closed;
    }
    if (out.of_plant[p].empty()) continue;
    for (auto& piece : piece_of)
      if (piece == no_parent) piece = static_cast<std::uint32_t>(out.of_plant[p].size());
    out.piece_of[p] = std::move(piece_of);
    closed.flip();
    PlantEntry rest = part_of(scene.plants[p], closed);
    if (rest.plant->shapes.empty()) continue;
    out.of_plant[p].push_back({static_cast<std::uint32_t>(out.pieces.size()), Affine{}, true});
    out.pieces.push_back(std::move(rest));
  }
  return out;
}

}  // namespace sunfleck
