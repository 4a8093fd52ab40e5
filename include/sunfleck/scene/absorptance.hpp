// What facets absorb of the light that they receive.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sunfleck/plant/optics.hpp>

namespace sunfleck {

/// Absorbed per one-sided area is (1 - rho_f - tau) E_f + (1 - rho_b - tau) E_b [W m^-2]: both factors of each material and band [-].
class Absorptance {
 public:
  Absorptance(const std::vector<Optics>& materials, std::size_t bands) : bands_(bands) {
    for (const auto& m : materials)
      for (std::size_t b = 0; b < bands; ++b)
        for (const float reflectance :
             {m.reflectance_front[b], m.reflectance_back[b]})  // rho + tau = 1 in float may exceed 1 by a rounding
          values_.push_back(std::max(0.0, 1.0 - double{reflectance} - double{m.transmittance[b]}));
  }

  /// Of light E_f, E_b on the two sides [W m^-2].
  double absorbed(std::uint32_t material, std::size_t band, double front, double back) const {
    const double* of_sides = &values_[(material * bands_ + band) * 2];
    return of_sides[0] * front + of_sides[1] * back;
  }

 private:
  std::size_t bands_;
  std::vector<double> values_;  ///< [material][b][front, back]
};

}  // namespace sunfleck
