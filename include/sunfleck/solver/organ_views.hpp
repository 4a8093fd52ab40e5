// How much of the sky and of the ground each organ sees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// View factors of the two sides, front and back, of m organs [-]: the share of the light that a side would send, as a Lambertian one,
/// which leaves the scene upwards (sky) or meets the ground first (ground),
///   1 / (pi A) integral over the side's area and its hemisphere of V cos(theta),
/// so that under a uniform sky of irradiance E a side of a black scene has sky x E from above. What is neither meets plants, or leaves
/// below the horizon.
struct OrganViews {
  std::size_t count = 0;
  std::vector<double> sky, ground;  ///< [m][2]
};

/// By `rays` rays from each side of each organ of a scene, in the order of the scene: the standard error of a value is at most
/// .5 / sqrt(rays), .016 for 1,024. Same bits for any number of threads. Throws InputError, Stopped.
OrganViews organ_views(const Scene& scene, std::uint32_t rays = 1024, std::uint64_t seed = 1, Progress& progress = silent());

}  // namespace sunfleck
