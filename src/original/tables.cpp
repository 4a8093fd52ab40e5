#include <sunfleck/original/tables.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>

#include "original/enforce.hpp"
#include "original/harmonics.hpp"
#include "original/octahedron.hpp"

namespace sunfleck {

namespace {

/// Values of the basis functions at a direction: all harmonics, or three shares.
struct AtDirection {
  std::array<double, harmonic_count(highest_order)> y{};
  std::array<std::uint32_t, 3> row{};
  std::size_t count = 0;
  std::uint32_t index(std::size_t k, bool harmonic) const { return harmonic ? static_cast<std::uint32_t>(k) : row[k]; }
};

AtDirection at(const OriginalTables& t, const Vec3& d) {
  AtDirection v;
  if (t.basis == TableSettings::Basis::harmonics) {
    harmonics(d, t.order, v.y.data());
    v.count = t.size();
  } else {
    const auto i = interpolate(d);
    v.row = i.row;
    std::copy(i.share.begin(), i.share.end(), v.y.begin());
    v.count = 3;
  }
  return v;
}

double series(const std::vector<double>& coefficients, const Vec3& w) {
  std::array<double, harmonic_count(highest_order)> y{};
  harmonics(w, highest_order, y.data());
  double sum = 0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += coefficients[i] * y[i];
  return sum;
}

/// transpose(R) f.
void turn_vector(const std::vector<double>& rotation, std::size_t n, double* f) {
  std::vector<double> turned(n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) turned[j] += rotation[i * n + j] * f[i];
  std::copy(turned.begin(), turned.end(), f);
}

/// transpose(R) S R.
void turn_matrix(const std::vector<double>& rotation, std::size_t n, double* s) {
  for (std::size_t i = 0; i < n; ++i) turn_vector(rotation, n, s + i * n);
  std::vector<double> column(n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) column[i] = s[i * n + j];
    turn_vector(rotation, n, column.data());
    for (std::size_t i = 0; i < n; ++i) s[i * n + j] = column[i];
  }
}

}  // namespace

double OriginalTables::intercepted_area(const Vec3& w) const {
  return std::max(0.0, series(sigma, w));
}

double OriginalTables::transmittance(const Vec3& w) const {
  const double hull_area = projected_area(hull, w);
  return hull_area > 0 ? std::clamp(1.0 - series(sigma, w) / hull_area, 0.0, 1.0) : 1.0;
}

double OriginalTables::absorbed_area(const Vec3& a, std::uint32_t band) const {
  const auto v = at(*this, a);
  const bool harmonic = basis == TableSettings::Basis::harmonics;
  double sum = 0;
  for (std::size_t k = 0; k < v.count; ++k) sum += v.y[k] * absorbed[band * size() + v.index(k, harmonic)];
  return sum;
}

double OriginalTables::scattered(const Vec3& a, const Vec3& b, std::uint32_t band) const {
  const auto va = at(*this, a), vb = at(*this, b);
  const bool harmonic = basis == TableSettings::Basis::harmonics;
  const double* s = phase.data() + band * size() * size();
  double sum = 0;
  for (std::size_t i = 0; i < va.count; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < vb.count; ++j) row += vb.y[j] * s[va.index(i, harmonic) * size() + vb.index(j, harmonic)];
    sum += va.y[i] * row;
  }
  return sum;
}

double OriginalTables::albedo(std::uint32_t band) const {
  const std::size_t n = size();
  double kept = 0, all = 0;
  for (std::size_t i = 0; i < (basis == TableSettings::Basis::harmonics ? 1 : n); ++i) {
    const double weight = basis == TableSettings::Basis::harmonics ? 1.0 : octahedron().weights[i];
    kept += weight * absorbed[band * n + i];
    all += weight * intercepted[i];
  }
  return all > 0 ? 1.0 - kept / all : 0.0;
}

double projected_area(const std::vector<Triangle>& hull, const Vec3& w) {
  double sum = 0;
  for (const auto& t : hull) sum += std::abs(glm::dot(area_vector(t), w));
  return 0.5 * sum;
}

OriginalTables transformed(const OriginalTables& tables, const Mat3& linear) {
  const double scale = std::cbrt(std::abs(glm::determinant(linear)));
  bool similar = scale > 0 && std::isfinite(scale);
  if (similar) {
    const Mat3 g = glm::transpose(linear) * linear / (scale * scale);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) similar = similar && std::abs(g[c][r] - (c == r ? 1.0 : 0.0)) < 1e-8;
  }
  if (!similar) throw Error("a copy that shears or stretches its original: it needs an original of its own");
  const Mat3 turn = linear / scale;
  OriginalTables out = tables;
  const std::size_t n = out.size();
  const auto fine = harmonic_rotation(turn, highest_order);
  turn_vector(fine, out.sigma.size(), out.sigma.data());
  if (out.basis == TableSettings::Basis::harmonics) {
    const auto rotation = harmonic_rotation(turn, out.order);
    turn_vector(rotation, n, out.intercepted.data());
    for (std::uint32_t b = 0; b < out.bands; ++b) {
      turn_vector(rotation, n, out.absorbed.data() + b * n);
      turn_matrix(rotation, n, out.phase.data() + b * n * n);
    }
  } else if (turn != Mat3{1.0}) {
    const auto& directions = octahedron().directions;
    std::vector<Interpolation> from;
    for (const auto& d : directions) from.push_back(interpolate(glm::transpose(turn) * d));
    for (std::size_t i = 0; i < n; ++i) {
      out.intercepted[i] = 0;
      for (std::size_t k = 0; k < 3; ++k) out.intercepted[i] += from[i].share[k] * tables.intercepted[from[i].row[k]];
      for (std::uint32_t b = 0; b < out.bands; ++b) {
        out.absorbed[b * n + i] = 0;
        for (std::size_t k = 0; k < 3; ++k) out.absorbed[b * n + i] += from[i].share[k] * tables.absorbed[b * n + from[i].row[k]];
        for (std::size_t j = 0; j < n; ++j)
          out.phase[(b * n + i) * n + j] = tables.scattered(glm::transpose(turn) * directions[i], glm::transpose(turn) * directions[j], b);
      }
    }
    const auto errors = out.errors;
    enforce_balance(out);
    out.errors = errors;
  }
  for (auto* list : {&out.sigma, &out.intercepted, &out.absorbed, &out.phase})
    for (auto& value : *list) value *= scale * scale;
  for (auto& t : out.hull) {
    for (auto& p : t) p = linear * p;
    if (glm::determinant(linear) < 0) std::swap(t[1], t[2]);
  }
  out.area_m2 *= scale * scale;
  return out;
}

double phase_difference(const OriginalTables& a, const OriginalTables& b, std::uint32_t band) {
  const std::size_t n = b.size();
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double weight = b.basis == TableSettings::Basis::harmonics ? 1.0 : octahedron().weights[i] * octahedron().weights[j];
      const double s = b.phase[(band * n + i) * n + j], d = a.phase[(band * n + i) * n + j] - s;
      difference += weight * d * d;
      all += weight * s * s;
    }
  return all > 0 ? std::sqrt(difference / all) : 0.0;
}

}  // namespace sunfleck
