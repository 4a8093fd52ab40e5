#include <sunfleck/light/split.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

GlobalSplit split_global(double global_irradiance, double elevation_deg, int day_of_year, const char* where) {
  if (!(global_irradiance >= 0.0) || !std::isfinite(global_irradiance))
    throw InputError(where, std::to_string(global_irradiance), "a global irradiance of 0 or more [W m^-2]");
  const double s = std::sin(elevation_deg * std::numbers::pi / 180.0);
  if (!(s > 0.0) || global_irradiance == 0.0) return {};
  const int day = std::clamp(day_of_year, 1, 366);
  const double outside = 1370.0 * (1.0 + 0.033 * std::cos(2.0 * std::numbers::pi * day / 365.0)) * s;  // on a horizontal plane
  const double clearness = global_irradiance / outside;
  const double rest = 0.847 - 1.61 * s + 1.04 * s * s, knee = (1.47 - rest) / 1.66;
  double diffuse = rest;
  if (clearness <= 0.22)
    diffuse = 1.0;
  else if (clearness <= 0.35)
    diffuse = 1.0 - 6.4 * (clearness - 0.22) * (clearness - 0.22);
  else if (clearness <= knee)
    diffuse = 1.47 - 1.66 * clearness;
  const double direct = std::min(1.0 - diffuse, 1.0 / clearness);
  return {direct, 1.0 - direct};
}

}  // namespace sunfleck
