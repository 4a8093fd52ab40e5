// Light from all round as nine numbers, and what it brings to a side of any direction.
#pragma once

#include <array>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

/// A directional light of a sky: as a share of an even grid of directions.
struct SkyDirection {
  Vec3 towards;  ///< unit vector
  double light;  ///< radiance x solid angle over the sky's horizontal irradiance [-]
};
/// Even in solid angle (a spherical Fibonacci lattice: Marques et al. 2013, doi:10.1111/cgf.12190), scaled so that they bring 1 to a
/// horizontal plane.
std::vector<SkyDirection> sky_directions(const Sky& sky, std::size_t count);

/// Spherical harmonics up to degree 2 of a light, in which irradiance is a quadratic form of the normal (Ramamoorthi & Hanrahan 2001,
/// doi:10.1145/383259.383317, equations 8 to 13).
class AmbientLight {
 public:
  void add(const Vec3& towards, double light);
  /// Irradiance on a side [of the unit of `light`]; never negative.
  double on(const Vec3& normal) const;
  /// Of the light, by its radiance; from none to one long: 0 where it comes alike from all round, 1/2 up under an even sky.
  Vec3 mean_direction() const;

 private:
  std::array<double, 9> c_{};  ///< 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2; times the constants of irradiance
};

}  // namespace sunfleck
