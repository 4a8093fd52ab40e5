// Real spherical harmonics, orthonormal over the sphere.
#pragma once

#include <cstddef>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

inline constexpr std::size_t highest_order = 6;
constexpr std::size_t harmonic_count(std::size_t order) {
  return (order + 1) * (order + 1);
}

/// Y_lm of a unit vector at index l^2 + l + m for l up to `order` <= highest_order, without the Condon-Shortley sign:
/// K P_lm(cos theta) times sqrt(2) cos(m phi) (m > 0), 1 (m = 0), sqrt(2) sin(|m| phi) (m < 0).
void harmonics(const Vec3& direction, std::size_t order, double* values);

/// Row i, column j of a band matrix R (harmonic_count(order)^2, row-major) with Y_i(transpose(turn) d) = sum_j R_ij Y_j(d), for an
/// orthogonal matrix, which may mirror. A function with coefficients f becomes transpose(R) f when it is turned.
std::vector<double> harmonic_rotation(const Mat3& turn, std::size_t order);

}  // namespace sunfleck
