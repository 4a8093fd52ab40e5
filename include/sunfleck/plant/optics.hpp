// Optical properties of two-sided, bi-Lambertian facets.
#pragma once

#include <string>
#include <vector>

namespace sunfleck {

/// Per band, dimensionless [-]: B_f = reflectance_front E_f + transmittance E_b, B_b = reflectance_back E_b + transmittance E_f
/// (radiant exitance B and irradiance E of the front and back sides). All values in [0, 1], reflectance + transmittance <= 1
/// on both sides.
struct Optics {
  std::string name;
  std::vector<float> reflectance_front, reflectance_back, transmittance;  ///< one value per band
};

}  // namespace sunfleck
