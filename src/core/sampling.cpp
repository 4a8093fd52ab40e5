#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Owen scrambling in base 2 as a hash of the reversed bits (Laine & Karras 2011; constants of Vegdahl 2021).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverse_bits(x);
}

/// Primitive polynomials and initial direction numbers of Joe & Kuo (new-joe-kuo-6), dimensions 2 to 8.
struct Polynomial {
  unsigned degree, coefficients;
  std::array<std::uint32_t, 5> initial;
};
constexpr Polynomial polynomials[7] = {{1, 0, {1}},          {2, 1, {1, 3}},        {3, 1, {1, 3, 1}},       {3, 2, {1, 1, 1}},
                                       {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}};

struct Directions {
  std::uint32_t v[8][32];
  constexpr Directions() : v{} {
    for (unsigned k = 0; k < 32; ++k) v[0][k] = 1u << (31 - k);
    for (unsigned d = 1; d < 8; ++d) {
      const auto& p = polynomials[d - 1];
      for (unsigned k = 0; k < 32; ++k) {
        if (k < p.degree) {
          v[d][k] = p.initial[k] << (31 - k);
        } else {
          v[d][k] = v[d][k - p.degree] ^ (v[d][k - p.degree] >> p.degree);
          for (unsigned j = 1; j < p.degree; ++j)
            if ((p.coefficients >> (p.degree - 1 - j)) & 1u) v[d][k] ^= v[d][k - j];
        }
      }
    }
  }
};
constexpr Directions directions;

}  // namespace

double sobol_owen(std::uint32_t n, unsigned dimension, std::uint32_t seed) {
  std::uint32_t x = 0;
  for (unsigned k = 0; n; ++k, n >>= 1)
    if (n & 1u) x ^= directions.v[dimension][k];
  return owen_scramble(x, static_cast<std::uint32_t>(mix(seed, dimension))) * 0x1.0p-32;
}

void orthonormal_frame(const Vec3& w, Vec3& u, Vec3& v) {
  const double sign = std::copysign(1.0, w.z), a = -1.0 / (sign + w.z), b = w.x * w.y * a;
  u = {1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x};
  v = {b, sign + w.y * w.y * a, -w.y};
}

}  // namespace sunfleck
