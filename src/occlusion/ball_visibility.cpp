#include <sunfleck/occlusion/ball_visibility.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunfleck {

namespace {

using std::numbers::pi;

/// Nodes in (0, 1) and weights that sum up to 1.
constexpr std::array<std::array<double, 2>, 8> gauss{{{0.019855071751231884, 0.050614268145188130},
                                                      {0.101666761293186630, 0.111190517226687240},
                                                      {0.237233795041835510, 0.156853322938943640},
                                                      {0.408282678752175100, 0.181341891689180990},
                                                      {0.591717321247824900, 0.181341891689180990},
                                                      {0.762766204958164500, 0.156853322938943640},
                                                      {0.898333238706813400, 0.111190517226687240},
                                                      {0.980144928248768100, 0.050614268145188130}}};
constexpr int azimuths = 16;  // of half a turn; the other half mirrors it
constexpr int parts = 2;      // into which the cosine is cut

}  // namespace

double ball_visibility(const BallPlace& place, double optical_radius) {
  const double r = std::clamp(place.radius, 0.0, 1.0), c = std::clamp(place.cosine, -1.0, 1.0);
  const double along = r * c, across = r * std::sqrt(std::max(0.0, 1.0 - c * c)), rest = std::max(0.0, 1.0 - r * r);
  double sum = 0.0;
  for (int part = 0; part < parts; ++part)
    for (const auto& [node, weight] : gauss) {
      const double mu = (part + node) / parts, sine = std::sqrt(1.0 - mu * mu);
      double ring = 0.0;
      for (int j = 0; j < azimuths; ++j) {
        const double b = along * mu + across * sine * std::cos(pi * (j + 0.5) / azimuths);
        ring += std::exp(-optical_radius * (std::sqrt(b * b + rest) - b));
      }
      sum += weight / parts * 2.0 * mu * ring / azimuths;
    }
  return sum;
}

double cap_visibility(const BallPlace& place, double optical_radius) {
  const double from_centre = place.radius * place.cosine, h = 1.0 - from_centre;
  const double d2 = std::max(0.0, place.radius * place.radius - from_centre * from_centre);
  const double cap = pi * h * h * (3.0 - h) / 3.0, f = h > 0.0 ? h * h / (h * h + d2) : 0.0;
  return std::exp(-1.5 * optical_radius / pi * f * cap);
}

double ball_transmission(double optical_radius) {
  const double k = 2.0 * optical_radius;
  if (k < 1e-3) return 1.0 - 2.0 * k / 3.0;
  return 2.0 * (1.0 - (1.0 + k) * std::exp(-k)) / (k * k);
}

BallTable::BallTable(double optical_radius) {
  for (std::size_t i = 0; i <= last; ++i)
    for (std::size_t j = 0; j <= last; ++j)
      values_[i * (last + 1) + j] =
          static_cast<float>(ball_visibility({static_cast<double>(i) / last, 2.0 * static_cast<double>(j) / last - 1.0}, optical_radius));
}

}  // namespace sunfleck
