// The extent of a scene and of its plants.
#pragma once

#include <string>

#include <sunfleck/scene/plant_sizes.hpp>

namespace sunfleck {

/// "extent x -0.5 .. 3.2, y -0.5 .. 1, z 0 .. 2.1 m; maize 2.1 m high, 1.2 m wide, from 0 m": the first eight plants.
std::string sizes_text(const Scene& scene, const SceneSizes& sizes);
/// "2.1 m high, 1.2 m wide, from 0 m".
std::string size_text(const PlantSize& size);

}  // namespace sunfleck
