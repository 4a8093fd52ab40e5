// Lamps and sensors in result files.
#pragma once

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>

#include "result/row_dataset.hpp"

namespace sunfleck::h5 {

/// /lamps; nothing if the scene has none.
void write_lamps(OutputFile& file, ArrayWriter& arrays, const Scene& scene);
/// /sensors and /names/sensor; nothing if the scene has none. Throws Error if readings are missing or not finite.
void write_sensors(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const std::vector<SensorReading>& readings);

}  // namespace sunfleck::h5
