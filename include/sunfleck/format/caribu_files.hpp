// Files of CARIBU beside .can: .opt, .light and .8, as openalea.caribu's file_adaptor.py (OpenAlea) reads them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Optical properties of one band.
struct CaribuOptics {
  /// A stem's reflectance, then reflectance and transmittance of a leaf's upper and lower side; -1 = not given.
  struct Species {
    double stem, upper_reflectance, upper_transmittance, lower_reflectance, lower_transmittance;
    long line;
  };
  std::string file, band;
  double soil = -1;  ///< reflectance; -1 = not given
  long soil_line = 0;
  std::vector<Species> species;  ///< numbered from 1 in .can files
};

/// A direction of a .light file: horizontal irradiance, and the unit vector towards the source.
struct LightDirection {
  double irradiance;
  Vec3 towards;
  long line;
};

// Throw InputError with file and line.

CaribuOptics read_opt(const std::string& file);
/// Directions with an irradiance above zero, at least one.
std::vector<LightDirection> read_light_file(const std::string& file);
/// xmin, ymin, xmax, ymax of a .8 file in its unit.
std::array<double, 4> read_pattern_file(const std::string& file);

}  // namespace sunfleck
