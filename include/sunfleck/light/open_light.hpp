// Light on planes that nothing hides.
#pragma once

#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

/// Irradiance of one side of a plane under the open sky, over the sky's horizontal irradiance [-]:
///     E(n) = integral of r(d) max(0, n . d) over all directions.
/// By 4096 directions, or pieces of the sky, for normals 3 degrees apart, between which it is linear: right to 0.1 % of the horizontal
/// irradiance for skies without a bright spot, and exact on a horizontal plane. A slope's own horizon is cut along pieces: .3 % more.
class OpenSky {
 public:
  explicit OpenSky(const Sky& sky);
  /// `normal` is a unit vector out of the side.
  double on(const Vec3& normal) const;

 private:
  static constexpr int rings = 60, columns = 120;
  bool round_ = true;          ///< the same towards all azimuths: one column is kept
  std::vector<double> value_;  ///< [rings + 1][columns or 1]
};

}  // namespace sunfleck
