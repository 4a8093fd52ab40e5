#include <sunfleck/light/sun.hpp>

#include <cmath>
#include <numbers>

namespace sunfleck {

Vec3 direction_from_angles(double elevation_deg, double azimuth_deg) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double horizontal = std::cos(elevation_deg * degree);
  return {horizontal * std::sin(azimuth_deg * degree), horizontal * std::cos(azimuth_deg * degree), std::sin(elevation_deg * degree)};
}

}  // namespace sunfleck
