// Sensors by path tracing.
#pragma once

#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Irradiance of every cell of every sensor, with the standard error of 16 randomisations. `samples`: paths per cell and side where the
/// sensor names none; 16 times as many per height of a profile.
/// `bounds`: of all facets with an area.
std::vector<SensorReading> sensor_readings(const Scene& scene, const Box& bounds, const PathSampler& sampler, std::uint32_t samples,
                                           std::uint64_t& rays, Progress& progress);

}  // namespace sunfleck
