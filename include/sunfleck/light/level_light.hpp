// Light from near the horizon in scenes that go on without end.
#pragma once

#include <algorithm>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// In a scene that goes on without end light from the unit vector `d` brings d.z of its irradiance onto each horizontal area, however low
/// it comes from. Where it is followed along a direction tilted up to z = `slope`, it brings slope times this share: d.z / slope, at most
/// 1, and 0 from the horizon and below.
inline double share_of_level_light(const Vec3& d, double slope) {
  return std::clamp(d.z / slope, 0.0, 1.0);
}

}  // namespace sunfleck
