// How large the plants of a scene are as they stand in it, and what of that is hardly meant.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Of all copies of a plant of the scene; by boxes, which under tilted placements are larger than the plant.
struct PlantSize {
  double height = 0, width = 0;    ///< of the largest copy: along z, and the larger of x and y [m]
  double lowest = 0, highest = 0;  ///< of all copies, z [m]
  bool placed = false;
};

struct SceneSizes {
  std::vector<PlantSize> plants;  ///< per row of Scene::plants
  Box plants_box, all;            ///< of plants alone, and with the ground [m]
};

/// Time: that of going over vertices and placements once; groups are entered once each.
SceneSizes scene_sizes(const Scene& scene);

/// "plant "coffee" is 160 m high: is its `unit` right?" for plants that are higher than 120 m, that lie below flat ground as a whole, or
/// whose leaves (organs of a type called leaf) are longer than 2 m on average.
std::vector<std::string> notes_on_sizes(const Scene& scene, const SceneSizes& sizes);

}  // namespace sunfleck
