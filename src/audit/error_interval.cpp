#include "error_interval.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

struct Mean {
  double value = 0, variance = 0;
  double skew = 0;  ///< third central moment of the mean, of those drawn by chance
};

/// Weighted mean, and its variance (a ratio estimator's) from those drawn by chance and the noise of those taken for sure.
template <class Value, class Noise>
Mean mean_of(std::span<const OrganError> organs, Value value, Noise noise) {
  Mean mean;
  double drawn = 0.0, share_of_drawn = 0.0, n = 0.0;
  for (const auto& o : organs) {
    mean.value += o.share * value(o);
    if (o.certain)
      mean.variance += o.share * o.share * noise(o);
    else
      drawn += o.share * value(o), share_of_drawn += o.share, n += 1.0;
  }
  if (n < 2.0 || !(share_of_drawn > 0.0)) return mean;
  drawn /= share_of_drawn;
  for (const auto& o : organs)
    if (!o.certain) {
      const double d = o.share * (value(o) - drawn);
      mean.variance += d * d * n / (n - 1.0);
      mean.skew += d * d * d;
    }
  return mean;
}

}  // namespace

ErrorEstimate estimate_error(std::span<const OrganError> organs) {
  const Mean square = mean_of(
      organs, [](const auto& o) { return o.square; }, [](const auto& o) { return o.square_variance; });
  const Mean bias = mean_of(
      organs, [](const auto& o) { return o.difference; }, [](const auto& o) { return o.difference_variance; });
  constexpr double z = 2.1;
  const double q = std::max(0.0, square.value), step = z * std::sqrt(square.variance);
  const double log_normal = 0.5 * step * step / (q + step / z + 1e-300);
  const double johnson = square.variance > 0.0 ? (1.0 + 2.0 * z * z) * square.skew / (6.0 * square.variance) : 0.0;
  const double high = q + step + std::max(log_normal, johnson);
  const double low = std::max(0.0, q - step);
  return {std::sqrt(q), std::sqrt(low), std::sqrt(high), std::sqrt(square.variance), bias.value, std::sqrt(bias.variance)};
}

}  // namespace sunfleck
