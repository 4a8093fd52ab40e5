#include <sunfleck/light/sky_table.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include <sunfleck/core/error.hpp>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

}  // namespace

SkyTable::SkyTable(std::vector<Vec3> directions, std::vector<double> radiances, const std::string& where)
    : directions_(std::move(directions)), radiances_(std::move(radiances)) {
  if (directions_.empty() || directions_.size() > most_directions || radiances_.size() != directions_.size())
    throw InputError(where, std::to_string(directions_.size()) + " directions and " + std::to_string(radiances_.size()) + " radiances",
                     "as many of each, from 1 to " + std::to_string(most_directions));
  std::set<std::tuple<double, double, double>> seen;
  double largest = 0;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const auto& d = directions_[i];
    const std::string which = "direction " + std::to_string(i + 1);
    if (!(std::abs(glm::length(d) - 1.0) < 1e-6) || !(d.z >= 0))
      throw InputError(where, which + " below the horizon, or no unit vector", "unit vectors at or above the horizon");
    if (!seen.insert({d.x, d.y, d.z}).second) throw InputError(where, which + " a second time", "every direction once");
    if (!(radiances_[i] >= 0) || std::isinf(radiances_[i]))
      throw InputError(where, "radiance " + std::to_string(radiances_[i]) + " of " + which, "finite numbers of zero or more");
    largest = std::max(largest, radiances_[i]);
  }
  if (!(largest > 0)) throw InputError(where, "radiances that are all zero", "at least one above zero");
  find_candidates();
  for (auto& r : radiances_) r /= largest;  // so that no sum overflows
  const auto cells = cell_integrals([](const Vec3&) { return 1.0; });
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) sum += radiances_[i] * cells[i];
  if (!(sum > 0)) throw InputError(where, "a sky that gives a horizontal plane no light", "radiances above zero above the horizon");
  normalisation_ = 1.0 / sum;
}

std::size_t SkyTable::place(const Vec3& d) const {
  const auto within = [](double v, std::uint32_t n) {
    return static_cast<std::size_t>(std::clamp(v * n, 0.0, static_cast<double>(n - 1)));
  };
  const double turn = std::atan2(d.y, d.x) / (2 * pi);
  return within(d.z, rings_) * 2 * rings_ + within(turn < 0 ? turn + 1 : turn, 2 * rings_);
}

/// A direction may be the nearest to a point of a place if it is nearer to the place's middle than the nearest one and twice the place's
/// radius.
void SkyTable::find_candidates() {
  rings_ = std::clamp(static_cast<std::uint32_t>(std::sqrt(static_cast<double>(directions_.size()))), 8u, 100u);
  const std::uint32_t sectors = 2 * rings_;
  first_.push_back(0);
  std::vector<double> cosine(directions_.size());
  for (std::uint32_t ring = 0; ring < rings_; ++ring)
    for (std::uint32_t sector = 0; sector < sectors; ++sector) {
      const double low = static_cast<double>(ring) / rings_, high = static_cast<double>(ring + 1) / rings_;
      const double azimuth = 2 * pi * (sector + 0.5) / sectors, half = pi / sectors;
      const Vec3 middle = direction_at(0.5 * (low + high), azimuth);
      double radius = 0;
      for (const double z : {low, high})
        for (const double a : {azimuth - half, azimuth, azimuth + half})
          radius = std::max(radius, std::acos(std::clamp(glm::dot(middle, direction_at(z, a)), -1.0, 1.0)));
      double best = -1;
      for (std::size_t i = 0; i < directions_.size(); ++i) best = std::max(best, cosine[i] = glm::dot(middle, directions_[i]));
      const double reach = std::acos(std::clamp(best, -1.0, 1.0)) + 2 * radius + 1e-6, least = reach < pi ? std::cos(reach) : -2.0;
      for (std::uint32_t i = 0; i < directions_.size(); ++i)
        if (cosine[i] >= least) candidates_.push_back(i);
      first_.push_back(static_cast<std::uint32_t>(candidates_.size()));
    }
}

std::uint32_t SkyTable::nearest(const Vec3& d) const {
  const std::size_t at = place(d);
  std::uint32_t found = candidates_[first_[at]];
  double best = -2;
  for (std::uint32_t c = first_[at]; c < first_[at + 1]; ++c)
    if (const double cosine = glm::dot(d, directions_[candidates_[c]]); cosine > best) best = cosine, found = candidates_[c];
  return found;
}

/// Points of a sunflower, each of the same solid angle: they keep no step with rings and azimuths of directions.
template <class Visit>
void SkyTable::each_point(Visit&& visit) const {
  const std::size_t points = std::max<std::size_t>(std::size_t{1} << 17, 400 * directions_.size());
  const double golden = pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < points; ++i)
    visit(direction_at((static_cast<double>(i) + 0.5) / static_cast<double>(points), golden * static_cast<double>(i)),
          2 * pi / static_cast<double>(points));
}

std::vector<double> SkyTable::cell_integrals(const std::function<double(const Vec3&)>& radiance) const {
  std::vector<double> sums(directions_.size(), 0.0);
  each_point([&](const Vec3& d, double solid_angle) { sums[nearest(d)] += radiance(d) * d.z * solid_angle; });
  return sums;
}

double SkyTable::widest_gap() const {
  double least = 1;
  each_point([&](const Vec3& d, double) { least = std::min(least, glm::dot(d, directions_[nearest(d)])); });
  return std::acos(std::clamp(least, -1.0, 1.0));
}

}  // namespace sunfleck
