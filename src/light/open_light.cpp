#include <sunfleck/light/open_light.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr int steps = 64;  // of the sine of the elevation, and of the azimuth

}  // namespace

OpenSky::OpenSky(const Sky& sky) : round_(!sky.sun || sky.model != SkyModel::clear) {
  std::vector<Vec3> towards;
  std::vector<double> radiance;
  const int halves = sky.reaches_below_horizon() ? 2 : 1;
  for (int i = 0; i < halves * steps; ++i)
    for (int j = 0; j < steps; ++j) {
      towards.push_back(direction_at(1.0 - (i + 0.5) / steps, 2.0 * pi * (j + 0.5 * (i % 2)) / steps));
      radiance.push_back(sky.relative_radiance(towards.back()) * 2.0 * pi / (steps * steps));
    }
  const auto at = [&](const Vec3& n) {
    double sum = 0;
    for (std::size_t k = 0; k < towards.size(); ++k) sum += radiance[k] * std::max(0.0, glm::dot(n, towards[k]));
    return sum;
  };
  const double horizontal = at({0.0, 0.0, 1.0});
  const int n = round_ ? 1 : columns;
  for (int ring = 0; ring <= rings; ++ring)
    for (int column = 0; column < n; ++column)
      value_.push_back(at(direction_at(std::cos(pi * ring / rings), 2.0 * pi * column / columns)) / horizontal);
}

double OpenSky::on(const Vec3& normal) const {
  const double ring = std::acos(std::clamp(normal.z, -1.0, 1.0)) / pi * rings;
  const int low = std::min(static_cast<int>(ring), rings - 1);
  const double part = ring - low;
  if (round_) return value_[low] + part * (value_[low + 1] - value_[low]);
  const double turns = std::atan2(normal.y, normal.x) / (2.0 * pi), at = (turns - std::floor(turns)) * columns;
  const int left = std::min(static_cast<int>(at), columns - 1), right = (left + 1) % columns;
  const auto between = [&](int row) {
    const double a = value_[row * columns + left], b = value_[row * columns + right];
    return a + (at - left) * (b - a);
  };
  return between(low) + part * (between(low + 1) - between(low));
}

}  // namespace sunfleck
