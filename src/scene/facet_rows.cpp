#include <sunfleck/scene/facet_rows.hpp>

#include <unordered_map>

namespace sunfleck {

namespace {

/// Strings that get a row when first seen.
class Interned {
 public:
  explicit Interned(std::vector<std::string>& rows) : rows_(rows) {}
  std::uint32_t row(const std::string& text) {
    const auto [place, added] = index_.try_emplace(text, static_cast<std::uint32_t>(rows_.size()));
    if (added) rows_.push_back(text);
    return place->second;
  }
  /// Of names of which none comes twice, and after which row() is not asked: nothing more is remembered.
  std::uint32_t last_row(const std::string& text) {
    if (const auto place = index_.find(text); place != index_.end()) return place->second;
    rows_.push_back(text);
    return static_cast<std::uint32_t>(rows_.size() - 1);
  }

 private:
  std::vector<std::string>& rows_;
  std::unordered_map<std::string, std::uint32_t> index_;
};

}  // namespace

FacetRows::FacetRows(const Scene& scene, const PlacedScene& placed)
    : scene_(scene), placed_(placed), materials_(scene.optics), plants_(scene.plants.size()) {
  if (scene.ground) materials_.push_back(scene.ground->optics);
  for (const auto& copy : placed.copies) {
    auto& rows = plants_[copy.plant];
    if (!rows.shape_first.empty()) continue;
    const Plant& plant = *scene.plants[copy.plant].plant;
    std::vector<std::uint32_t> organ_of(plant.structures.size(), no_parent);
    rows.shape_first.push_back(0);
    for (const auto& shape : plant.shapes) {
      auto& organ = organ_of[shape.structure];
      if (organ == no_parent) {
        organ = static_cast<std::uint32_t>(rows.organ_structure.size());
        rows.organ_structure.push_back(shape.structure);
      }
      rows.shape_organ.push_back(organ);
      rows.shape_first.push_back(rows.shape_first.back() + shape.triangle_count);
    }
  }
}

CopyFacet FacetRows::at(std::uint64_t row) const {
  const auto& copies = placed_.copies;
  if (row >= placed_.first_ground_facet)
    return {static_cast<std::uint32_t>(copies.size()), static_cast<std::uint32_t>(row - placed_.first_ground_facet)};
  // The last of those that begin there: plants without facets begin where the next does.
  const auto after = std::upper_bound(copies.begin(), copies.end(), row, [](std::uint64_t r, const auto& c) { return r < c.first_facet; });
  return {static_cast<std::uint32_t>(after - copies.begin() - 1), static_cast<std::uint32_t>(row - (after - 1)->first_facet)};
}

std::pair<std::uint32_t, std::uint32_t> FacetRows::organ_at(std::uint64_t row) const {
  const auto& copies = placed_.copies;
  if (row >= placed_.first_ground_organ)
    return {static_cast<std::uint32_t>(copies.size()), static_cast<std::uint32_t>(row - placed_.first_ground_organ)};
  const auto after = std::upper_bound(copies.begin(), copies.end(), row, [](std::uint64_t r, const auto& c) { return r < c.first_organ; });
  return {static_cast<std::uint32_t>(after - copies.begin() - 1), static_cast<std::uint32_t>(row - (after - 1)->first_organ)};
}

std::size_t FacetRows::shape_of(std::uint32_t plant, std::uint64_t facet) const {
  const auto& first = plants_[plant].shape_first;
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), facet) - first.begin()) - 1;
}

Triangle FacetRows::corners(CopyFacet f) const {
  Triangle found;
  visit(f.copy, f.facet, std::uint64_t{f.facet} + 1, [&](std::uint64_t, const Triangle& c, std::uint32_t, std::uint32_t) { found = c; });
  return found;
}

std::uint32_t FacetRows::material(CopyFacet f) const {
  if (is_ground(f.copy)) return ground_material();
  const auto plant = placed_.copies[f.copy].plant;
  return scene_.plants[plant].shape_optics[shape_of(plant, f.facet)];
}

std::uint32_t FacetRows::organ(CopyFacet f) const {
  if (is_ground(f.copy)) return placed_.ground.organ(f.facet);
  const auto plant = placed_.copies[f.copy].plant;
  return plants_[plant].shape_organ[shape_of(plant, f.facet)];
}

std::vector<std::uint32_t> FacetRows::organ_facets(std::uint32_t copy, std::uint32_t organ) const {
  std::vector<std::uint32_t> facets;
  if (is_ground(copy)) {
    for (std::size_t f = placed_.ground.first_facet(organ); f < placed_.ground.size() && placed_.ground.organ(f) == organ; ++f)
      facets.push_back(static_cast<std::uint32_t>(f));
    return facets;
  }
  const auto& rows = plants_[placed_.copies[copy].plant];
  for (std::size_t s = 0; s < rows.shape_organ.size(); ++s)
    if (rows.shape_organ[s] == organ)
      for (auto f = rows.shape_first[s]; f < rows.shape_first[s + 1]; ++f) facets.push_back(static_cast<std::uint32_t>(f));
  return facets;
}

OrganNames organ_names(const FacetRows& rows) {
  const Scene& scene = rows.scene();
  const PlacedScene& placed = rows.placed();
  OrganNames out;
  Interned names(out.names), types(out.types), plants(out.plants);
  out.of_plant.resize(scene.plants.size());
  std::vector<bool> known(scene.plants.size(), false);
  for (const auto& copy : placed.copies) {
    if (known[copy.plant]) continue;
    known[copy.plant] = true;
    const Plant& plant = *scene.plants[copy.plant].plant;
    auto& columns = out.of_plant[copy.plant];
    columns.plant = plants.row(scene.plants[copy.plant].name);
    columns.structure = rows.organ_structures(copy.plant);
    for (const auto structure : columns.structure) {
      columns.name.push_back(names.row(organ_name(plant, structure)));
      columns.type.push_back(types.row(plant.types[plant.structures[structure].type]));
    }
  }
  if (scene.ground) {
    out.ground.plant = plants.row("ground");
    const std::size_t organs = placed.ground.organs();
    out.ground.name.reserve(organs);
    for (std::size_t o = 0; o < organs; ++o) out.ground.name.push_back(names.last_row(placed.ground.organ_name(o)));
    if (organs > 0) out.ground.type.assign(organs, types.row("ground"));
    out.ground.structure.assign(organs, no_parent);
  }
  return out;
}

}  // namespace sunfleck
