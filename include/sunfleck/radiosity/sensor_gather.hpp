// What sensors measure in a solved scene.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/lamp_light.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

struct SensorSettings {
  std::uint32_t samples = 1024;  ///< rays per cell and side where the sensor says nothing; 16 times as many per height of a profile
  std::uint64_t seed = 1;
  bool scattered = true;  ///< false: light straight from sun, sky and lamps only; Surroundings::radiosity is not called
};

/// SensorSettings::samples of a quality: 256, 1024, 2048.
std::uint32_t sensor_samples(const RadiosityDensity& density);
/// Rays of a cell and side of a sensor; a multiple of the 8 randomisations.
std::uint32_t sensor_samples(const SensorEntry& sensor, const SensorSettings& settings);
/// Of all sensors and sides, for plans; `bounds` as for place_sensors.
std::uint64_t sensor_rays(const Scene& scene, const Box& bounds, const SensorSettings& settings);

/// E = E_gathered + E_sun + E_lamps on each side of each cell. E_gathered is the mean over cosine-weighted directions from points of the
/// cell: the sky's pi L where a ray leaves the scene, the radiosity of what it meets otherwise. Sun: shadow rays to points of its disc.
/// Lamps: as on facets (LampLight). Eight independent randomisations give mean and standard error. Rays start a clearance above
/// the side, so that a sensor that lies on the ground sees what the ground sees; sensors see neither each other nor lamps. Deterministic
/// for any number of threads. Throws Stopped.
std::vector<SensorReading> read_sensors(const Scene& scene, const std::vector<PlacedSensor>& sensors, const LampLight& lamps,
                                        const Surroundings& surroundings, const SensorSettings& settings, Progress& progress);

}  // namespace sunfleck
