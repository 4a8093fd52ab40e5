// A scene with every copy written out: one row a facet, in the order of the result file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Rows of string tables, one per organ.
struct OrganTable {
  std::vector<std::uint32_t> name, type, plant, placement;  ///< [m] rows of the tables below
  std::vector<std::string> names, types, plants, placements;
  std::vector<std::uint32_t> structure;  ///< [m] row of its plant's structures; no_parent for ground cells
  std::size_t size() const { return name.size(); }
};

/// Every mesh of the scene once, and every placed piece of it: enough to draw the scene and to open copies again.
struct PlacedShape {
  std::uint32_t plant;  ///< row of Scene::plants
  std::uint32_t shape;  ///< row of that plant's shapes
  std::uint32_t first_facet;
  std::uint32_t copy;  ///< which placed copy of the plant
};

/// Plants in scene order (placements in their order, then groups in scene order with their placements, members in theirs), then
/// ground cells. `n` facets, `m` organs.
struct FacetScene {
  std::vector<Triangle> corners;      ///< [n] world coordinates [m]
  std::vector<float> area;            ///< [n] one-sided [m^2]
  std::vector<std::uint32_t> optics;  ///< [n] row of `materials`
  std::vector<std::uint32_t> organ;   ///< [n] row of `organs`
  std::size_t plant_facets = 0;       ///< facets [0, plant_facets) belong to plants, the rest is ground
  OrganTable organs;
  std::vector<Optics> materials;          ///< Scene::optics, then the ground's
  std::vector<PlacedShape> shapes;        ///< in facet order, plants only
  std::vector<Affine> copies;             ///< placed copies of plants: plant frame -> world
  std::vector<std::uint32_t> copy_plant;  ///< row of Scene::plants
  Box bounds;                             ///< of facets with area
  std::size_t zero_area_facets = 0;       ///< kept as rows of zeros, never traced
  std::optional<PeriodicCell> periodic;
  std::size_t bands = 1;

  std::size_t size() const { return corners.size(); }
};

/// Writes out every copy of a scene that has passed check_scene(). Throws InputError if it has more than 2^31 facets, more than memory
/// holds, a facet of infinite area, or no facet and no sensor.
FacetScene expand(const Scene& scene);

}  // namespace sunfleck
