#include <sunfleck/light/panorama.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_set>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

constexpr double sun_reach = 2.5 * degree, sky_reach = 10.0 * degree;
constexpr double widest_sun = 8.0 * degree;  ///< across: a pixel of a picture of 64 columns
constexpr float least_over_sky = 50.0f, edge_over_sky = 10.0f;

struct Pixel {
  std::uint32_t row = 0, column = 0;
};

/// All pixels above the horizon within an angle of a direction. Rows are cut first: pictures have many pixels.
std::vector<Pixel> pixels_within(const Panorama& picture, const Vec3& middle, double angle) {
  std::vector<Pixel> found;
  const double zenith = std::acos(std::clamp(middle.z, -1.0, 1.0)), rows_of_angle = picture.rows / pi;
  const double first = std::max(0.0, (zenith - angle) * rows_of_angle - 1.0);
  const double last = std::min<double>(picture.rows_up(), (zenith + angle) * rows_of_angle + 1.0);
  const double least = std::cos(angle);
  for (auto row = static_cast<std::uint32_t>(first); row < last; ++row)
    for (std::uint32_t column = 0; column < picture.columns; ++column)
      if (glm::dot(picture.direction(row + 0.5, column + 0.5), middle) >= least) found.push_back({row, column});
  return found;
}

/// Median radiance of the sky about the sun, or of all of it where pixels are too wide.
float sky_about(const Panorama& picture, const Vec3& middle, double inner) {
  std::vector<float> values;
  const double outer = std::max(sky_reach, 4.0 * pi / picture.rows), most = std::cos(inner);
  for (const auto& p : pixels_within(picture, middle, outer))
    if (glm::dot(picture.direction(p.row + 0.5, p.column + 0.5), middle) < most) values.push_back(picture.at(p.row, p.column));
  if (values.empty()) values.assign(picture.value.begin(), picture.value.begin() + std::ptrdiff_t{picture.columns} * picture.rows_up());
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

/// Pixels above a radiance that hang together with the first, across the picture's edge too, until they cover a solid angle.
std::vector<Pixel> joined(const Panorama& picture, Pixel first, float above, double most_solid) {
  std::vector<Pixel> found{first};
  std::unordered_set<std::uint64_t> seen{std::uint64_t{first.row} * picture.columns + first.column};
  double solid = 0;
  for (std::size_t k = 0; k < found.size() && solid <= most_solid; ++k) {
    const Pixel p = found[k];
    solid += picture.solid_angle(p.row, p.row + 1.0);
    const auto look = [&](std::uint32_t row, std::uint32_t column) {
      if (picture.at(row, column) > above && seen.insert(std::uint64_t{row} * picture.columns + column).second)
        found.push_back({row, column});
    };
    for (std::uint32_t row = p.row - std::min(p.row, 1u); row < std::min(p.row + 2, picture.rows_up()); ++row)
      for (const std::uint32_t step : {picture.columns - 1, 0u, 1u}) look(row, (p.column + step) % picture.columns);
    for (std::uint32_t column = 0; p.row == 0 && column < picture.columns; ++column) look(0, column);  // about the zenith all touch
  }
  return found;
}

}  // namespace

Vec3 Panorama::direction(double row, double column) const {
  const double zenith = pi * row / rows, azimuth = turn_deg * degree + 2.0 * pi * (column / columns - 0.5);
  return {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
}

double Panorama::solid_angle(double row, double next_row) const {
  const auto cosine = [&](double r) { return std::cos(std::min(pi * r / rows, pi / 2)); };
  return 2.0 * pi / columns * (cosine(row) - cosine(next_row));
}

double Panorama::level_angle(double row, double next_row) const {
  const auto square = [&](double r) { return std::pow(std::sin(std::min(pi * r / rows, pi / 2)), 2); };
  return pi / columns * (square(next_row) - square(row));
}

Panorama shrunk(const Panorama& fine, std::uint32_t most_columns) {
  if (fine.columns <= most_columns) return fine;
  Panorama out;
  out.columns = most_columns;
  out.rows = most_columns / 2;
  out.turn_deg = fine.turn_deg;
  out.value.assign(std::size_t{out.columns} * out.rows, 0.0f);
  const double down = static_cast<double>(fine.rows) / out.rows, across = static_cast<double>(fine.columns) / out.columns;
  for (std::uint32_t row = 0; row < out.rows_up(); ++row) {
    const double top = row * down, bottom = top + down;
    for (std::uint32_t column = 0; column < out.columns; ++column) {
      const double left = column * across, right = left + across;
      double sum = 0, weights = 0;
      for (auto r = static_cast<std::uint32_t>(top); r < fine.rows_up() && r < bottom; ++r) {
        const double weight = fine.level_angle(std::max(top, static_cast<double>(r)), std::min(bottom, r + 1.0));
        for (auto c = static_cast<std::uint32_t>(left); c < fine.columns && c < right; ++c) {
          const double part = weight * (std::min(right, c + 1.0) - std::max(left, static_cast<double>(c)));
          sum += part * fine.at(r, c);
          weights += part;
        }
      }
      if (weights > 0) out.at(row, column) = static_cast<float>(sum / weights);
    }
  }
  return out;
}

std::optional<PicturedSun> take_sun(Panorama& picture) {
  Pixel brightest;
  for (std::uint32_t row = 0; row < picture.rows_up(); ++row)
    for (std::uint32_t column = 0; column < picture.columns; ++column)
      if (picture.at(row, column) > picture.at(brightest.row, brightest.column)) brightest = {row, column};
  const float most = picture.at(brightest.row, brightest.column);
  const Vec3 towards = picture.direction(brightest.row + 0.5, brightest.column + 0.5);
  if (!(most > 0) || !(towards.z > 0)) return std::nullopt;
  const double reach = std::max(sun_reach, 0.5 * pi / picture.rows);
  const float sky = sky_about(picture, towards, reach);
  if (!(most > least_over_sky * sky)) return std::nullopt;
  const double most_solid = 2.0 * pi * (1.0 - std::cos(0.5 * widest_sun));
  const auto pixels = joined(picture, brightest, edge_over_sky * sky, most_solid);

  double horizontal = 0, all = 0, solid = 0;
  Vec3 middle{0.0};
  for (const auto& p : pixels) {
    const double over = static_cast<double>(picture.at(p.row, p.column)) - sky, angle = picture.solid_angle(p.row, p.row + 1.0);
    horizontal += over * picture.level_angle(p.row, p.row + 1.0);
    middle += over * angle * picture.direction(p.row + 0.5, p.column + 0.5);
    solid += angle;
  }
  if (solid > most_solid || !(middle.z > 0)) return std::nullopt;
  for (std::uint32_t row = 0; row < picture.rows_up(); ++row)
    for (std::uint32_t column = 0; column < picture.columns; ++column)
      all += static_cast<double>(picture.at(row, column)) * picture.level_angle(row, row + 1.0);
  for (const auto& p : pixels) picture.at(p.row, p.column) = sky;
  return PicturedSun{glm::normalize(middle), horizontal / all};
}

}  // namespace sunfleck
