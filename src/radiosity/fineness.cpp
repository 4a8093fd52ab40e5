#include <sunfleck/radiosity/fineness.hpp>

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

RadiosityDensity beyond_fine() {
  auto d = density_of(Quality::fine);
  d.directions = 896;
  d.lines_per_element *= 1.4;
  d.elements_per_organ *= 1.5;
  d.sky_directions = 460;
  d.sky_lines_per_organ *= 1.6;
  d.sun_samples = 16;
  d.sun_lines_per_organ *= 2.5;
  d.link_error /= 1.5;
  d.fewest_hits *= 1.4;
  return d;
}

}  // namespace

RadiosityDensity density_at(double fineness) {
  const RadiosityDensity known[4] = {density_of(Quality::draft), density_of(Quality::standard), density_of(Quality::fine), beyond_fine()};
  const double at = std::clamp(fineness, coarsest_fineness, finest_fineness);
  const int below = std::min(static_cast<int>(at), 2);
  const double share = at - below;
  const auto &a = known[below], &b = known[below + 1];
  const auto between = [share](double low, double high) { return low * std::pow(high / low, share); };
  const auto count = [&](std::uint32_t low, std::uint32_t high) { return static_cast<std::uint32_t>(std::lround(between(low, high))); };
  return {.directions = count(a.directions, b.directions),
          .lines_per_element = between(a.lines_per_element, b.lines_per_element),
          .elements_per_organ = between(a.elements_per_organ, b.elements_per_organ),
          .sky_directions = count(a.sky_directions, b.sky_directions),
          .sky_lines_per_organ = between(a.sky_lines_per_organ, b.sky_lines_per_organ),
          .sun_samples = count(a.sun_samples, b.sun_samples),
          .sun_lines_per_organ = between(a.sun_lines_per_organ, b.sun_lines_per_organ),
          .link_error = between(a.link_error, b.link_error),
          .tolerance = between(a.tolerance, b.tolerance),
          .fewest_hits = between(a.fewest_hits, b.fewest_hits),
          .fewest_organs = between(a.fewest_organs, b.fewest_organs)};
}

}  // namespace sunfleck
