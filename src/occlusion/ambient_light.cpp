#include "occlusion/ambient_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/light/sky_parts.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

/// Squares of the harmonics' constants, times A_l: the clamped cosine's own, pi, 2 pi / 3, pi / 4.
constexpr double c0 = pi * (1.0 / (4.0 * pi)), c1 = 2.0 * pi / 3.0 * (3.0 / (4.0 * pi)), c2 = pi / 4.0 * (15.0 / (4.0 * pi)),
                 c20 = pi / 4.0 * (5.0 / (16.0 * pi)), c22 = pi / 4.0 * (15.0 / (16.0 * pi));

std::array<double, 9> harmonics(const Vec3& d) {
  return {1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y};
}

}  // namespace

std::vector<SkyDirection> sky_directions(const Sky& sky, std::size_t count) {
  const double golden = pi * (3.0 - std::sqrt(5.0));
  const bool round = sky.reaches_below_horizon();
  const std::size_t n = round ? 2 * count : count;
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < n; ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(n), z = round ? 1.0 - 2.0 * part : 1.0 - part;
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z)), azimuth = golden * static_cast<double>(i);
    directions.push_back({r * std::cos(azimuth), r * std::sin(azimuth), z});
  }
  const auto radiances = round ? std::vector<double>(n, sky.relative_radiance(Vec3{0.0, 0.0, 1.0})) : radiances_along(sky, directions);
  std::vector<SkyDirection> out;
  double horizontal = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back({directions[i], radiances[i]});
    horizontal += radiances[i] * std::max(0.0, directions[i].z);
  }
  for (auto& d : out) d.light = horizontal > 0.0 ? d.light / horizontal : 0.0;
  return out;
}

void AmbientLight::add(const Vec3& towards, double light) {
  constexpr std::array<double, 9> weight{c0, c1, c1, c1, c2, c2, c20, c2, c22};
  const auto h = harmonics(towards);
  for (std::size_t i = 0; i < h.size(); ++i) c_[i] += weight[i] * light * h[i];
}

Vec3 AmbientLight::mean_direction() const {
  return c_[0] > 0.0 ? Vec3{c_[3], c_[1], c_[2]} * (c0 / c1 / c_[0]) : Vec3{0.0};
}

double AmbientLight::on(const Vec3& normal) const {
  const auto h = harmonics(normal);
  double sum = 0.0;
  for (std::size_t i = 0; i < h.size(); ++i) sum += c_[i] * h[i];
  return std::max(0.0, sum);
}

}  // namespace sunfleck
