#include "occlusion/leaf_layer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/light/sky_parts.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr double extinction_of_leaves = 0.5;  // leaves turned all ways hide half their area
constexpr std::size_t elevations = 64, fewest_parts = 8192;

/// Integral of max(0, n . d) over all azimuths of d [rad]: of normals and directions of these sines and cosines.
double lit_azimuths(double nz, double z) {
  const double a = nz * z, b = std::sqrt(std::max(0.0, (1.0 - nz * nz) * (1.0 - z * z)));
  if (a >= b) return 2.0 * pi * a;
  if (a <= -b) return 0.0;
  const double half = std::acos(-a / b);
  return 2.0 * (a * half + b * std::sin(half));
}

}  // namespace

LeafProfile::LeafProfile(double low, double high, double ground_area)
    : low_(low), high_(std::max(high, low + 1e-9)), ground_area_(ground_area), above_(layers + 1, 0.0) {}

void LeafProfile::add(double height, double area) {
  const double at = (height - low_) / (high_ - low_) * layers;
  above_[std::min(static_cast<std::size_t>(std::max(0.0, at)), layers - 1)] += area;
}

void LeafProfile::finish() {
  const double scale = extinction_of_leaves / ground_area_;
  double sum = 0.0;
  for (std::size_t i = layers; i-- > 0;) above_[i] = sum += above_[i] * scale;
}

double LeafProfile::above(double height) const {
  const double at = std::clamp((height - low_) / (high_ - low_) * layers, 0.0, static_cast<double>(layers));
  const auto i = std::min(static_cast<std::size_t>(at), layers - 1);
  return above_[i] + (at - static_cast<double>(i)) * (above_[i + 1] - above_[i]);
}

LayerLight::LayerLight(const Sky& sky, double whole)
    : round_(sky.reaches_below_horizon()), whole_(whole), deepest_(std::max(whole, 1e-6)), values_((depths + 1) * (tilts + 1)) {
  // by elevation, denser towards the horizon, of which little is left in a layer
  std::vector<double> sine(elevations, 0.0), light(elevations, 0.0);
  each_part(sky, fewest_parts, [&](const Vec3& middle, double part, double) {
    const auto e = std::min(static_cast<std::size_t>(elevations * std::sqrt(std::max(0.0, middle.z))), elevations - 1);
    sine[e] += part * middle.z, light[e] += part;
  });
  for (std::size_t e = 0; e < elevations; ++e) sine[e] = light[e] > 0.0 ? sine[e] / light[e] : 1.0;
  for (std::size_t d = 0; d <= depths; ++d)
    for (std::size_t n = 0; n <= tilts; ++n) {
      const double part = static_cast<double>(d) / depths, depth = deepest_ * part * part, nz = 2.0 * static_cast<double>(n) / tilts - 1.0;
      double sum = 0.0;
      for (std::size_t e = 0; e < elevations; ++e)
        sum += light[e] / sine[e] * lit_azimuths(nz, sine[e]) / (2.0 * pi) * std::exp(-depth / sine[e]);
      values_[d * (tilts + 1) + n] = static_cast<float>(sum);
    }
}

double LayerLight::from_above(double normal_z, double depth) const {
  const double y = std::sqrt(std::clamp(depth / deepest_, 0.0, 1.0)) * depths, x = std::clamp(0.5 * (normal_z + 1.0), 0.0, 1.0) * tilts;
  const auto i = std::min(static_cast<std::size_t>(y), depths - 1), j = std::min(static_cast<std::size_t>(x), tilts - 1);
  const double u = y - static_cast<double>(i), v = x - static_cast<double>(j);
  const float* row = values_.data() + i * (tilts + 1) + j;
  return (1.0 - u) * ((1.0 - v) * row[0] + v * row[1]) + u * ((1.0 - v) * row[tilts + 1] + v * row[tilts + 2]);
}

double LayerLight::on(double normal_z, double above) const {
  const double light = from_above(normal_z, above);
  return round_ ? light + from_above(-normal_z, whole_ - above) : light;
}

}  // namespace sunfleck
