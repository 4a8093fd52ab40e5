#include <sunfleck/visibility/projection.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/scene/slope.hpp>

#include "golden_ratio.hpp"

namespace sunfleck {

namespace {

constexpr double fewest_periodic_lines = 1024.0;  ///< towards the zenith
constexpr double least_gain_on_slopes = 1e-3;     ///< of lines along the plane of a slope, which would meet all of it
constexpr double most_layers = 64.0;              ///< of surfaces over the cell, for which so many lines are affordable

/// Fewer where surfaces lie over the cell in very many layers (a plant a hundred cells wide): each line meets them all.
double fewest_lines(const Surface& surface, const PeriodicCell& cell) {
  double area = 0;
  for (std::size_t t = 0; t < surface.size(); ++t)
    if (surface.split[t] > 0) area += static_cast<double>(surface.cell_area[t]) * (surface.first_cell[t + 1] - surface.first_cell[t]);
  return fewest_periodic_lines / std::max(1.0, area / (most_layers * cell.area()));
}

Projection periodic_projection(const Surface& surface, const Vec3& d, double pitch, double shift_x, double shift_y) {
  const PeriodicCell& cell = *surface.periodic;
  Projection p;
  p.direction = d;
  p.wraps = true;
  // as many lines per perpendicular area in every direction: a horizontal pixel stands for its area times cos(zenith). Links count
  // lines of all directions alike, so small cells get finer grids, whose sizes round less.
  double lines = cell.area() / (pitch * pitch);
  if (lines < fewest_periodic_lines) lines = std::max(lines, fewest_lines(surface, cell));
  const double gain = cell.above(d);
  const Vec3 up{cell.above({1.0, 0.0, 0.0}), cell.above({0.0, 1.0, 0.0}), 1.0};  // the gradient of what is above the plane
  const double wanted = std::max(1.0, lines * gain);
  const auto middle = static_cast<int>(std::lround(std::sqrt(wanted * cell.width() / cell.depth())));
  double least = 1e30;
  for (int columns = std::max(1, middle - middle / 8), last = std::max(1, middle + middle / 8); columns <= last; ++columns) {
    const int rows = std::max(1, static_cast<int>(std::lround(wanted / columns)));
    const double error = std::fabs(static_cast<double>(columns) * rows - wanted);
    if (error >= least) continue;
    least = error;
    p.columns = columns;
    p.rows = rows;
  }
  const double per_x = p.columns / cell.width(), per_y = p.rows / cell.depth();
  p.x_row = (Vec3{1.0, 0.0, 0.0} - d.x / gain * up) * per_x;
  p.y_row = (Vec3{0.0, 1.0, 0.0} - d.y / gain * up) * per_y;
  p.z_row = up;
  p.x0 = (surface.origin.x - cell.x_low) * per_x + shift_x;
  p.y0 = (surface.origin.y - cell.y_low) * per_y + shift_y;
  p.line_area = cell.area() * gain / (static_cast<double>(p.columns) * p.rows);
  return p;
}

Projection finite_projection(const Surface& surface, const Vec3& d, double pitch, double turn, double shift_x, double shift_y) {
  Projection p;
  p.direction = d;
  Vec3 u, v;
  orthonormal_frame(d, u, v);
  const double c = std::cos(turn), s = std::sin(turn);
  const Vec3 x = c * u + s * v, y = c * v - s * u;
  const Vec3 half = 0.5 * surface.focus.size(), centre = surface.focus.empty() ? Vec3{0.0} : surface.focus.centre();
  const double reach_x = glm::dot(glm::abs(x), half), reach_y = glm::dot(glm::abs(y), half);
  constexpr double most = 1e9;
  if (!(2.0 * std::max(reach_x, reach_y) < most * pitch))
    throw InputError("scene",
                     fmt::format("{:.4g} m from end to end, crossed by lines {:.4g} m apart", 2.0 * std::max(reach_x, reach_y), pitch),
                     "plants that stand within 10^9 such distances of each other");
  p.columns = static_cast<int>(std::ceil(2.0 * reach_x / pitch)) + 2;
  p.rows = static_cast<int>(std::ceil(2.0 * reach_y / pitch)) + 2;
  p.x_row = x / pitch;
  p.y_row = y / pitch;
  p.z_row = d;
  p.x0 = (reach_x - glm::dot(x, centre)) / pitch + 0.5 + shift_x;
  p.y0 = (reach_y - glm::dot(y, centre)) / pitch + 0.5 + shift_y;
  p.line_area = pitch * pitch;
  return p;
}

/// Area of the part of a polygon where side * coordinate[axis] >= side * limit (Sutherland & Hodgman 1974, doi:10.1145/360767.360802).
struct Polygon {
  double x[16], y[16];
  int n = 0;
  void add(double px, double py) {
    x[n] = px;
    y[n++] = py;
  }
  Polygon clipped(bool along_x, double limit, double side) const {
    Polygon out;
    for (int i = 0; i < n; ++i) {
      const int j = i + 1 == n ? 0 : i + 1;
      const double a = side * ((along_x ? x[i] : y[i]) - limit), b = side * ((along_x ? x[j] : y[j]) - limit);
      if (a >= 0) out.add(x[i], y[i]);
      if ((a < 0) != (b < 0)) {
        const double t = a / (a - b);
        out.add(x[i] + t * (x[j] - x[i]), y[i] + t * (y[j] - y[i]));
      }
    }
    return out;
  }
  double area() const {
    double twice = 0;
    for (int i = 0; i < n; ++i) {
      const int j = i + 1 == n ? 0 : i + 1;
      twice += x[i] * y[j] - x[j] * y[i];
    }
    return std::fabs(0.5 * twice);
  }
};

}  // namespace

Projection project_along(const Surface& surface, const Vec3& direction, double pitch, double turn, double shift_x, double shift_y) {
  return surface.periodic ? periodic_projection(surface, along_lines(surface, direction), pitch, shift_x, shift_y)
                          : finite_projection(surface, direction, pitch, turn, shift_x, shift_y);
}

Vec3 hemisphere_direction(std::uint32_t d, std::uint32_t count, std::uint64_t seed) {
  const double z = (d + 0.5) / count, turns = d * golden_ratio_fraction + unit_interval(mix(seed));
  const double azimuth = 2.0 * std::numbers::pi * (turns - std::floor(turns)), s = std::sqrt(1.0 - z * z);
  return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

Vec3 along_lines(const Surface& surface, const Vec3& direction) {
  if (!surface.periodic || surface.periodic->is_level()) return direction;
  const Vec3 d = surface.periodic->above(direction) < 0.0 ? -direction : direction;
  return lifted(*surface.periodic, d, least_gain_on_slopes);
}

double depth_per_length(const Surface& surface, const Projection& projection) {
  return projection.wraps ? surface.periodic->above(projection.direction) : 1.0;
}

Projection project_set_member(const Surface& surface, const Vec3& direction, std::uint32_t d, double pitch, std::uint64_t seed) {
  const auto shift = r2_point(d, unit_interval(mix(seed, 1)), unit_interval(mix(seed, 2)));
  const double turn = d * golden_ratio_fraction + unit_interval(mix(seed, 3));
  return project_along(surface, direction, pitch, 2.0 * std::numbers::pi * (turn - std::floor(turn)), shift[0], shift[1]);
}

std::vector<OutsideArea> outside_focus(const Surface& surface, const Projection& p) {
  std::vector<OutsideArea> outside;
  if (p.wraps) return outside;
  for (std::size_t t = surface.focus_count; t < surface.size(); ++t) {
    const int k = surface.split[t];
    if (k == 0) continue;
    Vec3 c[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3 q{surface.corner[3 * i][t], surface.corner[3 * i + 1][t], surface.corner[3 * i + 2][t]};
      c[i] = {glm::dot(p.x_row, q) + p.x0, glm::dot(p.y_row, q) + p.y0, 0.0};
    }
    const Vec3 eu = (c[1] - c[0]) / static_cast<double>(k), ev = (c[2] - c[0]) / static_cast<double>(k);
    const bool front_up =
        surface.normal[0][t] * p.direction.x + surface.normal[1][t] * p.direction.y + surface.normal[2][t] * p.direction.z > 0;
    const double whole = 0.5 * std::fabs(eu.x * ev.y - eu.y * ev.x);
    const Vec3 low = glm::min(glm::min(c[0], c[1]), c[2]), high = glm::max(glm::max(c[0], c[1]), c[2]);
    if (low.x >= 0.0 && low.y >= 0.0 && high.x <= p.columns && high.y <= p.rows) continue;
    if (high.x <= 0.0 || high.y <= 0.0 || low.x >= p.columns || low.y >= p.rows) {
      for (std::uint32_t cell = surface.first_cell[t]; cell < surface.first_cell[t + 1]; ++cell)
        outside.push_back({cell, static_cast<float>(whole), front_up});
      continue;
    }
    for (int j = 0; j < k; ++j)
      for (int i = 0; i + j < k; ++i)
        for (int upper = 0; upper < (i + j < k - 1 ? 2 : 1); ++upper) {
          const Vec3 base = c[0] + static_cast<double>(i) * eu + static_cast<double>(j) * ev;
          const Vec3 a = upper ? base + eu + ev : base, b = base + eu, e = base + ev;
          Polygon polygon;
          for (const auto& q : {a, b, e}) polygon.add(q.x, q.y);
          const double inside =
              polygon.clipped(true, 0.0, 1.0).clipped(true, p.columns, -1.0).clipped(false, 0.0, 1.0).clipped(false, p.rows, -1.0).area();
          const double lines = whole - inside;
          if (lines > 1e-9 * whole)
            outside.push_back(
                {surface.first_cell[t] + static_cast<std::uint32_t>(j * (2 * k - j) + 2 * i + upper), static_cast<float>(lines), front_up});
        }
  }
  return outside;
}

}  // namespace sunfleck
