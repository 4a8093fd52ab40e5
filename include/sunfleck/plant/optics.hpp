// Optical properties of two-sided, bi-Lambertian facets.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace sunfleck {

/// Per band, dimensionless [-]: B_f = reflectance_front E_f + transmittance E_b, B_b = reflectance_back E_b + transmittance E_f
/// (radiant exitance B and irradiance E of the front and back sides). All values in [0, 1], reflectance + transmittance <= 1
/// on both sides.
struct Optics {
  std::string name;
  std::vector<float> reflectance_front, reflectance_back, transmittance;  ///< one value per band
  bool counts_as_leaf = true;  ///< in the absorbed fraction of leaves (fAPAR); light does not ask
};

/// Does it send on any light in any band?
inline bool scatters(const Optics& optics) {
  const auto bright = [](const std::vector<float>& values) {
    return std::any_of(values.begin(), values.end(), [](float v) { return v > 0.0f; });
  };
  return bright(optics.reflectance_front) || bright(optics.reflectance_back) || bright(optics.transmittance);
}

}  // namespace sunfleck
