#include "original/harmonics.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace sunfleck {

namespace {

constexpr std::size_t most = harmonic_count(highest_order);

/// Factors K_lm, with the sqrt(2) of m != 0.
std::array<double, most> normalisations() {
  std::array<double, most> k{};
  for (int l = 0; l <= static_cast<int>(highest_order); ++l)
    for (int m = -l; m <= l; ++m) {
      double ratio = 1.0;  // (l - |m|)! / (l + |m|)!
      for (int i = l - std::abs(m) + 1; i <= l + std::abs(m); ++i) ratio /= i;
      k[static_cast<std::size_t>(l * l + l + m)] = std::sqrt((m == 0 ? 1.0 : 2.0) * (2 * l + 1) / (4.0 * std::numbers::pi) * ratio);
    }
  return k;
}

/// Well spread directions, more than there are harmonics of a degree.
Vec3 spread_direction(std::size_t i, std::size_t count) {
  const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
  const double phi = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0)), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace

void harmonics(const Vec3& d, std::size_t order, double* values) {
  static const auto k = normalisations();
  const auto last = static_cast<int>(order);
  double cosine = 1.0, sine = 0.0;  // (x + i y)^m
  double first = 1.0;               // P_mm without its sin^m
  for (int m = 0; m <= last; ++m) {
    double below = 0.0, here = first;
    for (int l = m; l <= last; ++l) {
      const auto centre = static_cast<std::size_t>(l * l + l), shift = static_cast<std::size_t>(m);
      values[centre + shift] = k[centre + shift] * here * cosine;
      if (m > 0) values[centre - shift] = k[centre - shift] * here * sine;
      const double above = ((2 * l + 1) * d.z * here - (l + m) * below) / (l - m + 1);
      below = here;
      here = above;
    }
    first *= 2 * m + 1;
    const double turned = cosine * d.x - sine * d.y;
    sine = cosine * d.y + sine * d.x;
    cosine = turned;
  }
}

std::vector<double> harmonic_rotation(const Mat3& turn, std::size_t order) {
  const std::size_t n = harmonic_count(order), count = 4 * most;
  Eigen::MatrixXd plain(count, n), turned(count, n);
  std::array<double, most> y{};
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 d = spread_direction(i, count);
    harmonics(d, order, y.data());
    for (std::size_t j = 0; j < n; ++j) plain(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = y[j];
    harmonics(glm::transpose(turn) * d, order, y.data());
    for (std::size_t j = 0; j < n; ++j) turned(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = y[j];
  }
  std::vector<double> rotation(n * n, 0.0);
  for (std::size_t l = 0; l <= order; ++l) {  // degrees do not mix
    const auto begin = static_cast<Eigen::Index>(l * l), width = static_cast<Eigen::Index>(2 * l + 1);
    const Eigen::MatrixXd a = plain.middleCols(begin, width), b = turned.middleCols(begin, width);
    const Eigen::MatrixXd x = (a.transpose() * a).ldlt().solve(a.transpose() * b);
    for (Eigen::Index i = 0; i < width; ++i)
      for (Eigen::Index j = 0; j < width; ++j)
        rotation[static_cast<std::size_t>(begin + i) * n + static_cast<std::size_t>(begin + j)] = x(j, i);
  }
  return rotation;
}

}  // namespace sunfleck
