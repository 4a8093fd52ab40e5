// Deterministic sampling: hashing keyed by position in the scene, and low-discrepancy points.
#pragma once

#include <array>
#include <cstdint>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// splitmix64 finaliser: a bijection of 64-bit words with full avalanche (Steele, Lea, Flood 2014, doi:10.1145/2714064.2660195).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}
constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  return mix(mix(a) ^ b);
}
constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return mix(mix(a, b), c);
}

/// Uniform in [0, 1) with 53 bits.
constexpr double unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Small counter-based stream: the n-th number depends on (seed, n) only, so any order of work gives the same numbers.
class RandomStream {
 public:
  explicit constexpr RandomStream(std::uint64_t seed) : seed_(seed) {}
  constexpr double next() { return unit_interval(mix(seed_, counter_++)); }

 private:
  std::uint64_t seed_;
  std::uint64_t counter_ = 0;
};

/// Point n of the R2 sequence (Roberts 2018: additive recurrence by powers of the plastic number), shifted modulo 1.
inline std::array<double, 2> r2_point(std::uint64_t n, double shift_x = 0.0, double shift_y = 0.0) {
  const double x = shift_x + 0.7548776662466927 * static_cast<double>(n), y = shift_y + 0.5698402909980532 * static_cast<double>(n);
  return {x - std::floor(x), y - std::floor(y)};
}

/// Dimension d < 8 of point n of the Sobol' sequence (Joe & Kuo 2008, doi:10.1137/070709359), Owen-scrambled by hashing
/// (Laine & Karras 2011, doi:10.1111/j.1467-8659.2011.01968.x) with the seed given; in [0, 1).
double sobol_owen(std::uint32_t n, unsigned dimension, std::uint32_t seed);

/// Right-handed orthonormal frame (u, v, w) about the unit vector w (Duff et al. 2017, JCGT 6(1)).
void orthonormal_frame(const Vec3& w, Vec3& u, Vec3& v);

}  // namespace sunfleck
