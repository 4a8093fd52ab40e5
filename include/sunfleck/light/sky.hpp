// Sky radiance models, normalised by the irradiance on an unobstructed horizontal plane.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/perez.hpp>
#include <sunfleck/light/sky_image.hpp>
#include <sunfleck/light/sky_table.hpp>

namespace sunfleck {

enum class SkyModel { uniform, standard_overcast, clear, perez, file, image, sphere };

/// "uniform", "standard_overcast", "clear", "perez", "file", "image", "sphere"; std::nullopt for anything else.
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
  std::optional<Vec3> sun;                ///< unit vector towards the sun; `clear` and `perez` need it (also with the sun's beam left out)
  std::optional<PerezWeather> weather;    ///< `perez` needs it
  std::shared_ptr<const SkyTable> table;  ///< `file` needs it; results name the model only
  std::shared_ptr<const SkyImage> image;  ///< `image` needs it; so here
  Vec3 horizon{0, 0, 1};                  ///< of an endless slope: what lies below a plane of this normal is dark too, but for `sphere`
  double normalisation = 0.0;             ///< of `clear` and `perez`, by prepare_sky(): 1 / integral of their formula; 0 = not yet
  PerezShape shape;                       ///< of `perez`, by prepare_sky()

  /// Relative radiance towards the unit vector d [sr^-1].
  double relative_radiance(const Vec3& d) const;
  bool reaches_below_horizon() const { return model == SkyModel::sphere; }
  /// Has it a form of its own, rather than values of parts of the sky?
  bool is_formula() const { return model != SkyModel::file && model != SkyModel::image; }
  /// Is it built about the sun?
  bool needs_sun() const { return model == SkyModel::clear || model == SkyModel::perez; }
};

/// Has prepare_sky() been called, where the model needs it?
inline bool is_prepared(const Sky& sky) {
  return !sky.needs_sun() || sky.normalisation > 0;
}

/// Do two prepared skies have the same relative radiance everywhere?
bool same_radiance(const Sky& a, const Sky& b);

/// Computes the normalisation of models that have no closed form. Throws InputError if `clear` or `perez` has no sun direction above the
/// horizon, `perez` no weather (clearness 1 or more, brightness above 0), `file` no table or `image` no picture.
void prepare_sky(Sky& sky, const std::string& where);

}  // namespace sunfleck
