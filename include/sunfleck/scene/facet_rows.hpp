// Facets and organs of a placed scene by number, made on request: what a flat scene keeps in arrays, without the arrays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

/// A facet of a copy. `copy` is a row of PlacedScene::copies, or their number for the ground; `facet` counts from the copy's first.
struct CopyFacet {
  std::uint32_t copy = 0;
  std::uint32_t facet = 0;
  friend bool operator==(const CopyFacet&, const CopyFacet&) = default;
};

/// Corners, optics and organ of any facet, computed from the plants' meshes and the maps that place them: the same bits as expand().
/// Scene and placed scene must outlive it. Memory: 12 bytes a shape of a plant that is placed.
class FacetRows {
 public:
  FacetRows(const Scene& scene, const PlacedScene& placed);

  /// Scene::optics, then the ground's.
  const std::vector<Optics>& materials() const { return materials_; }
  std::uint32_t ground_material() const { return static_cast<std::uint32_t>(materials_.size() - 1); }
  const PlacedScene& placed() const { return placed_; }
  const Scene& scene() const { return scene_; }

  /// The copy that a row of the result's facets belongs to.
  CopyFacet at(std::uint64_t row) const;
  std::uint64_t row(CopyFacet f) const { return first_facet(f.copy) + f.facet; }
  /// The copy that a row of the result's organs belongs to, and which of its organs it is.
  std::pair<std::uint32_t, std::uint32_t> organ_at(std::uint64_t row) const;

  std::uint64_t first_facet(std::uint32_t copy) const {
    return is_ground(copy) ? placed_.first_ground_facet : placed_.copies[copy].first_facet;
  }
  std::uint64_t first_organ(std::uint32_t copy) const {
    return is_ground(copy) ? placed_.first_ground_organ : placed_.copies[copy].first_organ;
  }
  std::uint64_t facet_count(std::uint32_t copy) const {
    return is_ground(copy) ? placed_.ground.size() : placed_.plant_facets[placed_.copies[copy].plant];
  }
  std::uint64_t organ_count(std::uint32_t copy) const {
    return is_ground(copy) ? placed_.ground.organs() : placed_.plant_organs[placed_.copies[copy].plant];
  }
  bool is_ground(std::uint32_t copy) const { return copy == placed_.copies.size(); }

  Triangle corners(CopyFacet f) const;  ///< world [m]
  std::uint32_t material(CopyFacet f) const;
  std::uint32_t organ(CopyFacet f) const;  ///< among the organs of the copy
  /// Facets of an organ of a copy, rising.
  std::vector<std::uint32_t> organ_facets(std::uint32_t copy, std::uint32_t organ) const;
  /// Row of Plant::structures per organ of a plant that is placed.
  const std::vector<std::uint32_t>& organ_structures(std::uint32_t plant) const { return plants_[plant].organ_structure; }

  /// Calls visit(facet, corners in the world, material, organ of the copy) for the facets [first, last) of a copy, rising.
  template <class Visit>
  void visit(std::uint32_t copy, std::uint64_t first, std::uint64_t last, Visit&& visit) const;

 private:
  struct PlantRows {
    std::vector<std::uint64_t> shape_first;      ///< [shapes + 1] first facet of each
    std::vector<std::uint32_t> shape_organ;      ///< [shapes]
    std::vector<std::uint32_t> organ_structure;  ///< [m] row of Plant::structures
  };
  std::size_t shape_of(std::uint32_t plant, std::uint64_t facet) const;

  const Scene& scene_;
  const PlacedScene& placed_;
  std::vector<Optics> materials_;
  std::vector<PlantRows> plants_;  ///< per row of Scene::plants; empty where it is never placed
};

/// Names of organs, shared by all copies of a plant.
struct OrganNames {
  struct Columns {
    std::vector<std::uint32_t> name, type, structure;  ///< per organ; rows of names and types, and of Plant::structures
    std::uint32_t plant = 0;                           ///< row of plants
  };
  std::vector<std::string> names, types, plants;
  std::vector<Columns> of_plant;  ///< per row of Scene::plants; empty where it is never placed
  Columns ground;                 ///< structure is no_parent
};

/// Tables in the order in which the result's rows name things first. The placement of an organ is the path of its copy.
OrganNames organ_names(const FacetRows& rows);

template <class Visit>
void FacetRows::visit(std::uint32_t copy, std::uint64_t first, std::uint64_t last, Visit&& visit) const {
  if (is_ground(copy)) {
    for (std::uint64_t f = first; f < last; ++f) visit(f, placed_.ground[f], ground_material(), placed_.ground.organ(f));
    return;
  }
  const auto& placed = placed_.copies[copy];
  const auto& entry = scene_.plants[placed.plant];
  const auto& rows = plants_[placed.plant];
  for (std::size_t s = first < last ? shape_of(placed.plant, first) : 0; first < last; ++s) {
    const Shape& shape = entry.plant->shapes[s];
    const Mesh& mesh = entry.plant->meshes[shape.mesh];
    const Affine to_world = placed.map * shape.placement;
    const bool mirrors = to_world.mirrors();  // a mirror on a mirror leaves the order as it was
    const std::uint64_t begin = rows.shape_first[s], end = std::min(last, rows.shape_first[s + 1]);
    for (; first < end; ++first) {
      Triangle c = mesh.corners(shape.first_triangle + static_cast<std::uint32_t>(first - begin));
      for (auto& p : c) p = to_world.point(p);
      if (mirrors) std::swap(c[1], c[2]);
      visit(first, c, entry.shape_optics[s], rows.shape_organ[s]);
    }
  }
}

}  // namespace sunfleck
