// Which copies a scene holds and which rows of the result are theirs, without writing them out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Every facet of one plant in the plant's own frame, in file order; n facets, m organs.
struct PlantFacets {
  std::vector<Triangle> corners;               ///< [n] plant frame [m], fronts as in the file
  std::vector<std::uint32_t> optics;           ///< [n] row of Scene::optics
  std::vector<std::uint32_t> organ;            ///< [n] row of the plant's organs
  std::vector<std::uint32_t> organ_structure;  ///< [m] row of Plant::structures
  std::vector<std::uint32_t> shape_first;      ///< [shapes + 1] first facet of each shape
  std::size_t size() const { return corners.size(); }
  std::size_t organs() const { return organ_structure.size(); }
};

/// Writes out one plant once. Where a copy's map mirrors, corners 1 and 2 of its facets are swapped, so that fronts stay fronts.
PlantFacets plant_facets(const PlantEntry& entry);

/// Corners of a facet of a copy in the world [m].
inline Triangle placed_corners(const Triangle& corners, const Affine& map, bool mirrors) {
  Triangle c{map.point(corners[0]), map.point(corners[1]), map.point(corners[2])};
  if (mirrors) std::swap(c[1], c[2]);
  return c;
}

/// The name that the result gives an organ of a plant.
std::string organ_name(const Plant& plant, std::uint32_t structure);

/// A copy of a plant in the world.
struct PlacedCopy {
  std::uint32_t plant = 0;        ///< row of Scene::plants
  Affine map;                     ///< plant frame -> world
  std::uint64_t first_facet = 0;  ///< row of the result
  std::uint64_t first_organ = 0;  ///< row of the result
};

/// Rows of facets and organs in the order of the result file: plants in scene order (placements in their order), groups in scene order
/// with their placements, members in theirs; then ground cells. Memory: some 120 bytes a copy and what `ground` holds.
struct PlacedScene {
  std::vector<PlacedCopy> copies;
  std::vector<std::string> paths;           ///< per copy: "tile[3]/coffee[1]"
  std::vector<std::uint64_t> plant_facets;  ///< per row of Scene::plants: facets of one copy
  std::vector<std::uint64_t> plant_organs;  ///< per row of Scene::plants: organs of one copy
  std::vector<Triangle> ground;             ///< facets of the ground, world [m]
  std::vector<std::uint32_t> ground_organ;  ///< [ground facets] row among the ground's organs
  std::vector<std::string> ground_names;    ///< per organ of the ground
  std::uint64_t first_ground_facet = 0, first_ground_organ = 0;
  std::uint64_t facets = 0, organs = 0;  ///< in all
};

/// Lays out a scene that has passed check_scene(). Throws InputError if it has no facet or more copies than memory holds.
PlacedScene place(const Scene& scene);

}  // namespace sunfleck
