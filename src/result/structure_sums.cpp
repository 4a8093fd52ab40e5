#include <sunfleck/result/structure_sums.hpp>

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

/// The structures of a plant that get rows, and which row each of its organs goes to.
struct PlantStructures {
  StructureCuts cuts;
  bool rest = false;  ///< has facets outside all of them
};

PlantStructures structures_of(const Plant& plant, const StopAt& stop) {
  PlantStructures out{cut_structures(plant, stop)};
  for (const auto& shape : plant.shapes) out.rest = out.rest || (shape.triangle_count > 0 && out.cuts.of_structure[shape.structure] == 0);
  return out;
}

std::string path_of(const Plant& plant, std::uint32_t structure) {
  std::string text;
  for (auto s = structure; s != 0 && s != no_parent; s = plant.structures[s].parent) text = "/" + organ_name(plant, s) + text;
  return text;
}

}  // namespace

bool stops_inside(const PlacedScene& placed) {
  return !placed.depth.stop_at.empty() && !placed.copies.empty();
}

PlacedScene structures_layout(const Scene& scene, const PlacedScene& placed) {
  PlacedScene out;
  out.plant_facets = placed.plant_facets;
  out.plant_organs = placed.plant_organs;
  out.ground = placed.ground;
  out.facets = placed.ground.size();
  out.organs = placed.ground.organs();
  out.closed = placed.closed;
  out.partial = placed.partial;
  out.depth = placed.depth;
  std::map<std::uint32_t, PlantStructures> known;
  bool any = false;
  for (std::size_t c = 0; c < placed.copies.size(); ++c) {
    const auto plant = placed.copies[c].plant;
    const auto& p = *scene.plants[plant].plant;
    const auto at = known.find(plant);
    const auto& structures = at != known.end() ? at->second : known.emplace(plant, structures_of(p, placed.depth.stop_at)).first->second;
    any = any || structures.cuts.closed() > 0;
    for (std::size_t k = structures.rest ? 0 : 1; k < structures.cuts.structures.size(); ++k) {
      const auto s = structures.cuts.structures[k];
      out.closed.push_back({placed.paths[c] + path_of(p, s), false, plant, s, placed.copies[c].map, true});
    }
  }
  if (any) return out;
  std::set<std::string> types;
  for (const auto& [plant, s] : known)
    for (const auto& structure : scene.plants[plant].plant->structures) types.insert(scene.plants[plant].plant->types[structure.type]);
  const std::vector<std::string> list(types.begin(), types.end());
  const auto& stop = placed.depth.stop_at;
  const std::string nearest = nearest_name(stop.type, list);
  throw InputError(
      location(scene.file, 0, "solve.stop_at"),
      stop.type.empty() ? "a limit that no structure of the plants keeps" : fmt::format("\"{}\", a type that no structure has", stop.type),
      fmt::format("one of {}{}", joined(list), nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

StructureSums::StructureSums(const Scene& scene, const PlacedScene& placed, const PlacedScene& layout, IrradianceSink& ground)
    : scene_(scene),
      placed_(placed),
      layout_(layout),
      ground_(ground),
      rows_(scene, placed),
      absorptance_(rows_.materials(), scene.band_count()) {
  const std::size_t values = scene.states.size() * scene.band_count();
  std::map<std::uint32_t, std::size_t> count;
  std::size_t row = 0;
  for (const auto& copy : placed.copies) {
    if (!row_of_organ_.count(copy.plant)) {
      const auto s = structures_of(*scene.plants[copy.plant].plant, placed.depth.stop_at);
      auto& of_organ = row_of_organ_[copy.plant];
      for (const auto structure : rows_.organ_structures(copy.plant)) of_organ.push_back(s.cuts.of_structure[structure] - (s.rest ? 0 : 1));
      count[copy.plant] = s.cuts.closed() + (s.rest ? 1 : 0);
    }
    first_row_.push_back(row);
    row += count[copy.plant];
  }
  sums_.assign(row * values, 0.0);
}

void StructureSums::rows(const IrradianceRows& r) {
  const std::size_t states = scene_.states.size(), bands = scene_.band_count();
  for (std::size_t at = 0; at < r.count;) {
    const CopyFacet start = rows_.at(r.first_facet + at);
    const auto copy = start.copy;
    const auto first = start.facet;
    if (rows_.is_ground(copy)) {
      if (at > 0) throw Error("rows of plants and of the ground arrived together");
      IrradianceRows ground = r;
      ground.first_facet = r.first_facet - placed_.first_ground_facet + layout_.first_ground_facet;
      return ground_.rows(ground);
    }
    const std::size_t count = std::min<std::size_t>(r.count - at, rows_.facet_count(copy) - first);
    const auto& of_organ = row_of_organ_.at(placed_.copies[copy].plant);
    rows_.visit(copy, first, first + count, [&](std::uint64_t facet, const Triangle& corners, std::uint32_t material, std::uint32_t organ) {
      const double area = glm::length(area_vector(corners));
      const std::size_t i = at + (facet - first);
      for (std::size_t s = 0; s < states; ++s)
        for (std::size_t b = 0; b < bands; ++b) {
          const float* sides = r.irradiance + ((s * r.count + i) * 2) * bands + b;
          sums_[((first_row_[copy] + of_organ[organ]) * states + s) * bands + b] +=
              area * absorptance_.absorbed(material, b, sides[0], sides[bands]);
        }
    });
    at += count;
  }
}

}  // namespace sunfleck
