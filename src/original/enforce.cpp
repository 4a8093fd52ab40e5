#include "original/enforce.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "original/octahedron.hpp"

namespace sunfleck {

namespace {

/// Symmetric S; returns rms(S(a,b) - S(b,a)) / 2 over rms(S).
double symmetrise(double* s, std::size_t n) {
  double odd = 0, all = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double mean = 0.5 * (s[i * n + j] + s[j * n + i]), half = 0.5 * (s[i * n + j] - s[j * n + i]);
      s[i * n + j] = s[j * n + i] = mean;
      odd += i == j ? 0.0 : 2.0 * half * half;
      all += i == j ? mean * mean : 2.0 * mean * mean;
    }
  return all > 0 ? std::sqrt(odd / all) : 0.0;
}

double relative(double squared, double of) {
  return of > 0 ? std::sqrt(squared / of) : 0.0;
}

double balance_harmonics(double* s, const double* scattered, std::size_t n) {
  const double whole = std::sqrt(4.0 * std::numbers::pi);
  double missing = 0, all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double wanted = scattered[i] / whole;
    missing += (s[i * n] - wanted) * (s[i * n] - wanted);
    all += wanted * wanted;
    s[i * n] = s[i] = wanted;
  }
  return relative(missing, all);
}

double balance_directions(double* s, const double* scattered, std::size_t n) {
  const auto& weights = octahedron().weights;
  double missing = 0, all = 0;
  std::vector<double> wanted(n), d(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    wanted[i] = std::max(scattered[i], 0.0);
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += s[i * n + j] * weights[j];
    missing += weights[i] * (sum - wanted[i]) * (sum - wanted[i]);
    all += weights[i] * wanted[i] * wanted[i];
  }
  // d_i <- sqrt(d_i wanted_i / sum_j S_ij d_j w_j): the mean, in logarithms, of Sinkhorn's two half steps.
  for (int step = 0; step < 1000; ++step) {
    double worst = 0;
    std::vector<double> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += s[i * n + j] * d[j] * weights[j];
      next[i] = wanted[i] > 0 && sum > 0 ? std::sqrt(d[i] * wanted[i] / sum) : 0.0;
      if (wanted[i] > 0) worst = std::max(worst, std::abs(d[i] * sum / wanted[i] - 1.0));
    }
    if (worst < 1e-13) break;
    d = next;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) s[i * n + j] *= d[i] * d[j];
  return relative(missing, all);
}

}  // namespace

void enforce_balance(OriginalTables& t) {
  const std::size_t n = t.size();
  t.errors.resize(t.bands);
  std::vector<double> scattered(n);
  for (std::uint32_t b = 0; b < t.bands; ++b) {
    double* s = t.phase.data() + b * n * n;
    t.errors[b].reciprocity = symmetrise(s, n);
    for (std::size_t i = 0; i < n; ++i) scattered[i] = t.intercepted[i] - t.absorbed[b * n + i];
    t.errors[b].energy =
        t.basis == TableSettings::Basis::harmonics ? balance_harmonics(s, scattered.data(), n) : balance_directions(s, scattered.data(), n);
  }
}

}  // namespace sunfleck
