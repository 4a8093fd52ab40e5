// How the light of a lamp is spread over directions, as photometric files give it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Far-field intensities of a luminaire in its own frame (IES LM-63, photometry of type C). The *aim* (nadir, vertical angle 0) is -z;
/// horizontal angle 0, the plane of the luminaire's length, is +x; horizontal angles run counter-clockwise seen from +z.
/// Angles [degrees] rise. Horizontal angles are {0} (the same all round), 0 to 90 (four equal quadrants), 0 to 180 or 90 to 270 (two
/// equal halves), or 0 to 360. Outside the vertical angles there is no light; between angles values are interpolated linearly.
struct Photometry {
  std::string file;
  std::vector<double> vertical_deg;    ///< [v] two or more, within 0 to 180
  std::vector<double> horizontal_deg;  ///< [h]
  std::vector<double> candela;         ///< [h][v] any unit: only their ratios count
  double length_m = 0, width_m = 0;    ///< of the luminous opening along x and y; both 0 = a point
  bool round = false;                  ///< the opening is an ellipse, not a rectangle
  double per_candela = 0;              ///< set by prepare_photometry(): 1 / integral of candela over all directions

  /// Intensity per power towards the unit vector `d` of the lamp's frame [sr^-1]; its integral over the sphere is 1.
  double intensity(const Vec3& d) const;
};

/// Checks angles and values and computes the normalisation: exactly for values linear between vertical angles. Throws InputError(where).
void prepare_photometry(Photometry& photometry, const std::string& where);

}  // namespace sunfleck
