// Angles in radians, and directions by them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

inline constexpr double degree = std::numbers::pi / 180.0;

/// Unit vector with the sine z of its elevation, at an azimuth counted from x towards y.
inline Vec3 direction_at(double z, double azimuth) {
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

}  // namespace sunfleck
