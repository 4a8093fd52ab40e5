// Directions for Lambertian surfaces.
#pragma once

#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

/// Unit vector about the unit normal n with a density of cos / pi, for u and v even in [0, 1): a point of the unit disc, lifted onto the
/// hemisphere (Malley's method).
inline Vec3 cosine_direction(const Vec3& n, double u, double v) {
  Vec3 a, b;
  orthonormal_frame(n, a, b);
  const double r = std::sqrt(u), azimuth = 2.0 * std::numbers::pi * v;
  return r * std::cos(azimuth) * a + r * std::sin(azimuth) * b + std::sqrt(1.0 - u) * n;
}

}  // namespace sunfleck
