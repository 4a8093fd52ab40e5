// Does the interval of the certificate hold the truth as often as it says? Simulated.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <sunfleck/core/sampling.hpp>

#include "audit/error_interval.hpp"

using namespace sunfleck;

namespace {

double gauss(RandomStream& random) {
  const double u = 1.0 - random.next(), v = random.next();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

struct Coverage {
  double rmse = 0, bias = 0;
};

/// Errors of 3,000 organs, of which `heavy` makes some much larger than others; path tracing's noise is `noise` times their rmse.
Coverage coverage(double heavy, double noise, int organs, bool certain, int runs) {
  RandomStream make(42);
  std::vector<double> error(certain ? organs : 3000), deviation(error.size());
  double square = 0, mean = 0;
  for (auto& e : error) {
    const double scale = std::exp(heavy * gauss(make));
    e = scale * (0.8 * gauss(make) + 0.3);
    square += e * e / static_cast<double>(error.size());
    mean += e / static_cast<double>(error.size());
  }
  const double truth = std::sqrt(square);
  for (auto& d : deviation) d = noise * truth * std::exp(0.3 * gauss(make));
  Coverage inside;
  for (int run = 0; run < runs; ++run) {
    RandomStream random(1000 + run);
    std::vector<OrganError> checked;
    for (int k = 0; k < organs; ++k) {
      const auto i = certain ? static_cast<std::size_t>(k) : static_cast<std::size_t>(random.next() * static_cast<double>(error.size()));
      double parts[16], m = 0, v = 0;
      for (auto& p : parts) m += (p = error[i] + 4 * deviation[i] * gauss(random)) / 16;
      for (const auto p : parts) v += (p - m) * (p - m) / (16 * 15);
      const double q = m * m - v;
      checked.push_back({1.0 / organs, certain, q, 4 * std::max(0.0, q) * v + 2 * v * v * (1 + 1.0 / 15), m, v});
    }
    const auto estimate = estimate_error(checked);
    inside.rmse += (estimate.low <= truth && truth <= estimate.high) / double(runs);
    inside.bias += (std::abs(estimate.bias - mean) <= 1.96 * estimate.bias_standard_error) / double(runs);
  }
  return inside;
}

}  // namespace

TEST_CASE("the certificate's interval holds the true error in at least nine of ten runs") {
  for (const double heavy : {0.0, 0.4, 0.6})  // kurtosis of the errors about 3, 6 and 13
    for (const double noise : {0.2, 0.5, 1.0, 2.0}) {
      const auto drawn = coverage(heavy, noise, 240, false, 200);
      CAPTURE(heavy, noise);
      CHECK(drawn.rmse >= 0.9);
      CHECK(drawn.bias >= 0.9);
      const auto all = coverage(heavy, noise, 100, true, 200);
      CHECK(all.rmse >= 0.9);
      CHECK(all.bias >= 0.9);
    }
}

TEST_CASE("the certificate's interval narrows with more organs and less noise, and orders its ends") {
  RandomStream random(3);
  const auto width = [&](int organs, double noise) {
    std::vector<OrganError> checked;
    for (int k = 0; k < organs; ++k) {
      const double d = gauss(random), m = d + noise * gauss(random);
      checked.push_back({1.0 / organs, false, m * m - noise * noise, 0, m, noise * noise});
    }
    const auto e = estimate_error(checked);
    CHECK(e.low <= e.rmse);
    CHECK(e.rmse <= e.high);
    return e.high - e.low;
  };
  CHECK(width(320, 0.1) < width(40, 0.1));
  CHECK(width(320, 0.1) < width(320, 2.0));
  const auto none = estimate_error({});
  CHECK(none.rmse == 0.0);
  CHECK(none.high == 0.0);
}
