#include <sunfleck/light/open_light.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/light/sky_parts.hpp>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr int steps = 64;  // of the sine of the elevation, and of the azimuth

}  // namespace

OpenSky::OpenSky(const Sky& given) : round_(!given.needs_sun() && given.is_formula() && given.horizon == Vec3{0, 0, 1}) {
  Sky sky = given;  // all of it, of which a slope hides a part
  sky.horizon = {0, 0, 1};
  std::vector<Vec3> towards;  // times radiance and solid angle
  if (has_detail(sky)) {
    // what falls from each piece of the sky, as one direction: exact for planes that see all or nothing of the piece
    towards.assign(std::size_t{steps} * steps, Vec3{0.0});
    const auto piece = [](double part) { return static_cast<std::size_t>(std::clamp(static_cast<int>(part * steps), 0, steps - 1)); };
    each_part(sky, std::size_t{1} << 18, [&](const Vec3& d, double light, double) {
      const double turns = std::atan2(d.y, d.x) / (2.0 * pi);
      if (d.z > 0) towards[piece(1.0 - d.z) * steps + piece(turns - std::floor(turns))] += light / d.z * d;
    });
  } else {
    const int halves = sky.reaches_below_horizon() ? 2 : 1;
    for (int i = 0; i < halves * steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const Vec3 d = direction_at(1.0 - (i + 0.5) / steps, 2.0 * pi * (j + 0.5 * (i % 2)) / steps);
        towards.push_back(sky.relative_radiance(d) * 2.0 * pi / (steps * steps) * d);
      }
  }
  const auto at = [&](const Vec3& n) {
    double sum = 0;
    for (const auto& light : towards) sum += std::max(0.0, glm::dot(n, light));
    return sum;
  };
  const double horizontal = at({0.0, 0.0, 1.0});
  if (!sky.reaches_below_horizon() && given.horizon != sky.horizon)
    std::erase_if(towards, [&](const Vec3& light) { return !(glm::dot(light, given.horizon) > 0.0); });
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
