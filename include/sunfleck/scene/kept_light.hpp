// A sink that keeps all rows in memory: for programs that go on with the light at once.
#pragma once

#include <cstddef>
#include <vector>

#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Light on every facet. s states, n facets, b bands; memory: 4 (2 b + 2 + b) bytes a facet and state.
class KeptLight : public IrradianceSink {
 public:
  KeptLight(std::size_t states, std::size_t facets, std::size_t bands) : states_(states), n_(facets), bands_(bands) {
    irradiance.resize(states * facets * 2 * bands);
    sunlit.resize(states * facets * 2);
    variance.resize(states * facets * bands);
  }

  void rows(const IrradianceRows& r) override {
    in_order = in_order && r.first_facet == next_;
    next_ = r.first_facet + r.count;
    const auto copy = [&](std::vector<float>& to, const float* from, std::size_t width) {
      if (!from) return;
      for (std::size_t s = 0; s < states_; ++s)
        for (std::size_t k = 0; k < r.count * width; ++k) to[(s * n_ + r.first_facet) * width + k] = from[s * r.count * width + k];
    };
    copy(irradiance, r.irradiance, 2 * bands_);
    copy(sunlit, r.sunlit, 2);
    copy(variance, r.variance_of_absorbed, bands_);
  }

  /// Have all rows arrived, in their order?
  bool complete() const { return in_order && next_ == n_; }
  /// Irradiance of a side, 0 front, 1 back [W m^-2].
  double on(std::size_t facet, int side, std::size_t band = 0, std::size_t state = 0) const {
    return irradiance[((state * n_ + facet) * 2 + static_cast<std::size_t>(side)) * bands_ + band];
  }
  double variance_of(std::size_t facet, std::size_t band = 0, std::size_t state = 0) const {
    return variance[(state * n_ + facet) * bands_ + band];
  }

  std::vector<float> irradiance;  ///< [s][n][2][b] front, back [W m^-2]
  std::vector<float> sunlit;      ///< [s][n][2]; zeros without sun
  std::vector<float> variance;    ///< [s][n][b] of absorbed; zeros unless the reference method gave it
  bool in_order = true;

 private:
  std::size_t states_, n_, bands_, next_ = 0;
};

}  // namespace sunfleck
