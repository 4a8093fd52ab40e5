// Sky radiance models, normalised by the irradiance on an unobstructed horizontal plane.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/sky_table.hpp>

namespace sunfleck {

enum class SkyModel { uniform, standard_overcast, clear, file, sphere };

/// "uniform", "standard_overcast", "clear", "file", "sphere"; std::nullopt for anything else.
std::optional<SkyModel> sky_model_from_name(const std::string& name);
std::string name_of(SkyModel model);
/// All names, for messages.
const std::vector<std::string>& sky_model_names();

/// A sky: relative radiance r(d) with the integral of r(d) cos(zenith) over the upper hemisphere equal to 1, so that the
/// radiance of a band is r(d) [sr^-1] x irradiance [W m^-2]. What lies below the horizon is black, but for `sphere`, which has
/// the same radiance 1/pi all round (for tests).
struct Sky {
  SkyModel model = SkyModel::uniform;
  std::vector<double> irradiance;         ///< per band, horizontal, unobstructed [W m^-2]
  std::optional<Vec3> sun;                ///< unit vector towards the sun; `clear` needs it (also with the sun's beam left out)
  std::shared_ptr<const SkyTable> table;  ///< `file` needs it; results name the model only
  double clear_normalisation = 0.0;       ///< set by prepare_sky(): 1 / integral of the unnormalised clear sky; 0 = not yet

  /// Relative radiance towards the unit vector d [sr^-1].
  double relative_radiance(const Vec3& d) const;
  bool reaches_below_horizon() const { return model == SkyModel::sphere; }
};

/// Has prepare_sky() been called, where the model needs it?
inline bool is_prepared(const Sky& sky) {
  return sky.model != SkyModel::clear || sky.clear_normalisation > 0;
}

/// Computes the normalisation of models that have no closed form. Throws InputError if `clear` has no sun direction above the horizon, or
/// `file` no table.
void prepare_sky(Sky& sky, const std::string& where);

}  // namespace sunfleck
