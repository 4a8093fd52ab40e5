#include <sunfleck/instantiation/fineness.hpp>

#include <algorithm>
#include <cmath>

#include <sunfleck/radiosity/fineness.hpp>

namespace sunfleck {

namespace {

InstantiationDensity beyond_fine() {
  auto d = instantiation_density(Quality::fine);
  d.coarse.directions = 128;
  d.coarse.lines_per_organ *= 1.4;
  d.fine.directions = 360;
  d.fine.lines_per_organ *= 1.4;
  d.elements_per_organ *= 1.5;
  d.sun_samples = 16;
  d.sun_lines_per_organ *= 2.5;
  d.ground_rays *= 2;
  return d;
}

double between(double low, double high, double share) {
  return low * std::pow(high / low, share);
}

std::uint32_t between(std::uint32_t low, std::uint32_t high, double share) {
  return static_cast<std::uint32_t>(std::lround(between(double(low), double(high), share)));
}

OperatorDensity between(const OperatorDensity& a, const OperatorDensity& b, double share) {
  return {.directions = between(a.directions, b.directions, share),
          .lines_per_organ = between(a.lines_per_organ, b.lines_per_organ, share),
          .field_pixels = between(a.field_pixels, b.field_pixels, share),
          .points = between(a.points, b.points, share)};
}

}  // namespace

InstantiationDensity instantiation_density_at(double fineness) {
  const InstantiationDensity known[4] = {instantiation_density(Quality::draft), instantiation_density(Quality::standard),
                                         instantiation_density(Quality::fine), beyond_fine()};
  const double at = std::clamp(fineness, coarsest_fineness, finest_fineness);
  const int below = std::min(static_cast<int>(at), 2);
  const double share = at - below;
  const auto &a = known[below], &b = known[below + 1];
  return {.coarse = between(a.coarse, b.coarse, share),
          .fine = between(a.fine, b.fine, share),
          .elements_per_organ = between(a.elements_per_organ, b.elements_per_organ, share),
          .sun_samples = between(a.sun_samples, b.sun_samples, share),
          .sun_lines_per_organ = between(a.sun_lines_per_organ, b.sun_lines_per_organ, share),
          .ground_rays = between(a.ground_rays, b.ground_rays, share),
          .tolerance = between(a.tolerance, b.tolerance, share),
          .inner_tolerance = between(a.inner_tolerance, b.inner_tolerance, share)};
}

}  // namespace sunfleck
