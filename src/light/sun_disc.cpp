#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/light/wide_sun.hpp>

namespace sunfleck {

namespace {

constexpr double most_widths = 1000.0;  ///< penumbrae wider than so many leaves are smooth

double angular_radius(const Sun& sun) {
  return 0.5 * sun.angular_diameter_deg * std::numbers::pi / 180.0;
}

}  // namespace

std::vector<Vec3> sun_disc(const Sun& sun, std::uint32_t points, std::uint64_t seed) {
  const double radius = angular_radius(sun), turn = 2.0 * std::numbers::pi * unit_interval(mix(seed));
  Vec3 u, v;
  orthonormal_frame(sun.direction, u, v);
  std::vector<Vec3> out;
  for (std::uint32_t i = 0; i < points; ++i) {
    const double share = (i + 0.5) / points;  // of the disc's solid angle
    const bool narrow = sun.angular_diameter_deg <= widest_narrow_sun_deg;
    const double r = narrow ? radius * std::sqrt(share) : std::acos(1.0 - share * (1.0 - std::cos(radius)));
    const double a = 2.399963229728653 * i + turn;
    out.push_back(glm::normalize(sun.direction + std::tan(r) * (std::cos(a) * u + std::sin(a) * v)));
  }
  return out;
}

std::uint32_t sun_disc_points(const Sun& sun, std::uint32_t fewest, double way, double leaf_area) {
  if (!(leaf_area > 0.0)) return fewest;
  const double widths = std::min(2.0 * angular_radius(sun) * way / std::sqrt(leaf_area), most_widths);
  return static_cast<std::uint32_t>(std::lround(fewest * (1.0 + widths)));
}

}  // namespace sunfleck
