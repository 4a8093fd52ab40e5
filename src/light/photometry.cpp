#include <sunfleck/light/photometry.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

/// Where x lies among rising values: low row and the part of the way to the next.
struct Between {
  std::size_t row;
  double part;
};
Between between(const std::vector<double>& values, double x) {
  if (values.size() == 1) return {0, 0.0};
  const auto above = std::upper_bound(values.begin(), values.end(), x) - values.begin();
  const auto row = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(values.size()) - 2));
  return {row, std::clamp((x - values[row]) / (values[row + 1] - values[row]), 0.0, 1.0)};
}

/// Horizontal angle folded into the range that is given.
double folded(const std::vector<double>& given, double angle) {
  const double last = given.back();
  if (given.front() == 90.0) return angle < 90.0 ? 180.0 - angle : angle > 270.0 ? 540.0 - angle : angle;
  if (last <= 90.0) {
    angle = std::fmod(angle, 180.0);
    return angle > 90.0 ? 180.0 - angle : angle;
  }
  return last <= 180.0 && angle > 180.0 ? 360.0 - angle : angle;
}

void check_rising(const std::vector<double>& angles, const std::string& where, const char* what) {
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (!std::isfinite(angles[i])) throw InputError(where, fmt::format("a {} angle of {}", what, angles[i]), "finite degrees");
    if (i > 0 && !(angles[i] > angles[i - 1]))
      throw InputError(where, fmt::format("{} angle {} after {}", what, angles[i], angles[i - 1]), "angles that rise");
  }
}

}  // namespace

double Photometry::intensity(const Vec3& d) const {
  const double vertical = std::acos(std::clamp(-d.z, -1.0, 1.0)) / degree;
  if (vertical < vertical_deg.front() || vertical > vertical_deg.back()) return 0.0;
  double horizontal = 0.0;
  if (horizontal_deg.size() > 1) {
    horizontal = std::atan2(d.y, d.x) / degree;
    horizontal = folded(horizontal_deg, horizontal < 0.0 ? horizontal + 360.0 : horizontal);
  }
  const auto v = between(vertical_deg, vertical), h = between(horizontal_deg, horizontal);
  const auto column = [&](std::size_t row) {
    const double* c = candela.data() + row * vertical_deg.size() + v.row;
    return c[0] + v.part * (c[1] - c[0]);
  };
  const double low = column(h.row);
  return per_candela * (h.part > 0.0 ? low + h.part * (column(h.row + 1) - low) : low);
}

void prepare_photometry(Photometry& p, const std::string& where) {
  if (p.vertical_deg.size() < 2) throw InputError(where, fmt::format("{} vertical angles", p.vertical_deg.size()), "two or more");
  if (p.horizontal_deg.empty()) throw InputError(where, "no horizontal angle", "one or more");
  check_rising(p.vertical_deg, where, "vertical");
  check_rising(p.horizontal_deg, where, "horizontal");
  if (p.vertical_deg.front() < 0.0 || p.vertical_deg.back() > 180.0)
    throw InputError(where, fmt::format("vertical angles from {} to {}", p.vertical_deg.front(), p.vertical_deg.back()),
                     "0 to 180 degrees");
  const double first = p.horizontal_deg.front(), last = p.horizontal_deg.back();
  const bool known = p.horizontal_deg.size() == 1
                         ? first == 0.0
                         : (first == 0.0 && (last == 90.0 || last == 180.0 || last == 360.0)) || (first == 90.0 && last == 270.0);
  if (!known)
    throw InputError(where, fmt::format("horizontal angles from {} to {}", first, last),
                     "0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360 degrees");
  const std::size_t rows = p.vertical_deg.size();
  if (p.candela.size() != rows * p.horizontal_deg.size())
    throw InputError(where, fmt::format("{} intensities", p.candela.size()),
                     fmt::format("{}: one per pair of angles", rows * p.horizontal_deg.size()));
  for (const double c : p.candela)
    if (!(c >= 0.0) || std::isinf(c)) throw InputError(where, fmt::format("an intensity of {}", c), "finite values of zero or more");
  for (const double length : {p.length_m, p.width_m})
    if (!(length >= 0.0) || std::isinf(length)) throw InputError(where, fmt::format("an opening of {} m", length), "a finite length");

  // integral of (a + b t) sin t = [-(a + b t) cos t + b sin t], t the vertical angle; the trapezoidal rule over horizontal angles
  std::vector<double> column(p.horizontal_deg.size(), 0.0);
  for (std::size_t h = 0; h < column.size(); ++h)
    for (std::size_t v = 0; v + 1 < rows; ++v) {
      const double t0 = p.vertical_deg[v] * degree, t1 = p.vertical_deg[v + 1] * degree;
      const double c0 = p.candela[h * rows + v], c1 = p.candela[h * rows + v + 1], slope = (c1 - c0) / (t1 - t0);
      column[h] += c0 * std::cos(t0) - c1 * std::cos(t1) + slope * (std::sin(t1) - std::sin(t0));
    }
  double mean = column.front();
  if (column.size() > 1) {
    mean = 0.0;
    for (std::size_t h = 0; h + 1 < column.size(); ++h)
      mean += 0.5 * (column[h] + column[h + 1]) * (p.horizontal_deg[h + 1] - p.horizontal_deg[h]) / (last - first);
  }
  const double total = 2.0 * pi * mean;
  if (!(total > 0.0) || std::isinf(total)) throw InputError(where, "intensities that are zero in all directions", "a lamp that shines");
  p.per_candela = 1.0 / total;
}

}  // namespace sunfleck
