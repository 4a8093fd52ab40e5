// How much of the light around a ball of small, evenly spread, randomly turned leaves reaches a point within it.
#pragma once

#include <array>
#include <vector>

namespace sunfleck {

/// A place and a side within a unit ball: all that visibility depends on there, but for the ball's optical radius k R, where k [m^-1] is
/// half the leaf area density (G = 1/2) and R the radius [m].
struct BallPlace {
  double radius = 0;  ///< distance from the centre over the ball's radius [-], 0 to 1
  double cosine = 0;  ///< between the side's normal and the way out from the centre [-], -1 to 1
};

/// Share of an even light from all round that reaches a side [-], weighted by the cosine on it, as irradiance is:
///     V = 1/pi integral over the side's hemisphere of (n . w) exp(-k l(w)) dw,   l(w): the way out of the ball.
/// By Gauss-Legendre points in the cosine and even ones in azimuth; right to 1e-4 for k R up to 8, and to .005 where a side touches the
/// rim. Closed forms: at the centre exp(-k R); at the rim outward 1, inward 2 (1 - (1 + 2 k R) exp(-2 k R)) / (2 k R)^2.
double ball_visibility(const BallPlace& place, double optical_radius);

/// The same as Hegeman, Premoze, Ashikhmin & Drettakis (2006, "Approximate ambient occlusion for trees", doi:10.1145/1111411.1111426,
/// equations 4 to 6) have it: V = exp(-alpha rho f V_cap), V_cap the volume of the cap that the side's plane cuts off,
/// f = h^2 / (h^2 + d^2), h its height and d the plane's distance from the axis. They set alpha rho by hand; here it is
/// 3 k R / (2 pi R^3), which is exact at the centre.
double cap_visibility(const BallPlace& place, double optical_radius);

/// Share of parallel light that passes through a ball, over its shadow [-]: 2 (1 - (1 + 2 k R) exp(-2 k R)) / (2 k R)^2.
double ball_transmission(double optical_radius);

/// ball_visibility() of one ball from 16 x 16 values, bilinear: within .014 (rms) up to k R = 4.
class BallTable {
 public:
  explicit BallTable(double optical_radius);
  double at(const BallPlace& place) const {
    const double r = place.radius * last, c = 0.5 * (place.cosine + 1.0) * last;
    const auto i = r < last ? static_cast<std::size_t>(r) : last - 1, j = c < last ? static_cast<std::size_t>(c) : last - 1;
    const double u = r - static_cast<double>(i), v = c - static_cast<double>(j);
    const float* row = values_.data() + i * (last + 1) + j;
    return (1.0 - u) * ((1.0 - v) * row[0] + v * row[1]) + u * ((1.0 - v) * row[last + 1] + v * row[last + 2]);
  }

 private:
  static constexpr std::size_t last = 15;
  std::array<float, (last + 1) * (last + 1)> values_{};
};

}  // namespace sunfleck
