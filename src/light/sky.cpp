#include <sunfleck/light/sky.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

/// Relative luminance of the CIE standard clear sky (CIE S 011:2003 type 12, polluted-free atmosphere; the sky of Kittler 1967),
/// without its constant factors: gradation phi(z) = 1 - exp(-0.32 / cos z) times indicatrix
/// f(chi) = 1 + 10 (exp(-3 chi) - exp(-3 pi / 2)) + 0.45 cos^2 chi, chi the angle to the sun [rad].
double clear_sky(double cos_zenith, double cos_chi) {
  const double chi = std::acos(std::clamp(cos_chi, -1.0, 1.0));
  const double gradation = 1.0 - std::exp(-0.32 / cos_zenith);  // towards the horizon the exponential ends at 0
  const double indicatrix = 1.0 + 10.0 * (std::exp(-3.0 * chi) - std::exp(-1.5 * pi)) + 0.45 * cos_chi * cos_chi;
  return gradation * indicatrix;
}

const std::vector<std::string> names = {"uniform", "standard_overcast", "clear", "perez", "file", "image", "sphere"};

}  // namespace

const std::vector<std::string>& sky_model_names() {
  return names;
}

std::string name_of(SkyModel model) {
  return names[static_cast<std::size_t>(model)];
}

std::optional<SkyModel> sky_model_from_name(const std::string& name) {
  const auto place = std::find(names.begin(), names.end(), name);
  if (place == names.end()) return std::nullopt;
  return static_cast<SkyModel>(place - names.begin());
}

double Sky::relative_radiance(const Vec3& d) const {
  if (model == SkyModel::sphere) return 1.0 / pi;
  if (!(d.z > 0.0) || !(glm::dot(d, horizon) > 0.0)) return 0.0;
  switch (model) {
    case SkyModel::standard_overcast:
      return 3.0 * (1.0 + 2.0 * d.z) / (7.0 * pi);
    case SkyModel::clear:
      return normalisation * clear_sky(d.z, glm::dot(d, *sun));
    case SkyModel::perez:
      return normalisation * perez_luminance(shape, d.z, glm::dot(d, *sun));
    case SkyModel::image:
      return image ? image->relative_radiance(d) : 0.0;
    case SkyModel::file:
      return table ? table->relative_radiance(d) : 0.0;
    default:
      return 1.0 / pi;
  }
}

bool same_radiance(const Sky& a, const Sky& b) {
  if (a.model != b.model || a.horizon != b.horizon) return false;
  const auto same = [](const auto& x, const auto& y) { return x == y || (x && y && *x == *y); };
  if (a.model == SkyModel::file) return same(a.table, b.table);
  if (a.model == SkyModel::image) return same(a.image, b.image);
  if (!a.needs_sun()) return true;
  const auto same_weather = [&] { return a.weather->clearness == b.weather->clearness && a.weather->brightness == b.weather->brightness; };
  return a.sun && b.sun && *a.sun == *b.sun && (a.model == SkyModel::clear || (a.weather && b.weather && same_weather()));
}

void prepare_sky(Sky& sky, const std::string& where) {
  if (sky.model == SkyModel::file && !sky.table)
    throw InputError(where, "a sky of directions without any", "a table of directions and radiances");
  if (sky.model == SkyModel::image && !sky.image) throw InputError(where, "a sky of a picture without any", "a picture of the sky");
  if (!sky.needs_sun()) return;
  const std::string about = "a sun above the horizon, about which the " + name_of(sky.model) + " sky is built";
  if (!sky.sun) throw InputError(where, "a " + name_of(sky.model) + " sky without a sun", about);
  if (!(sky.sun->z > 0.0)) throw InputError(where, "a " + name_of(sky.model) + " sky with the sun below the horizon", about);
  if (sky.model == SkyModel::perez) {
    if (!sky.weather) throw InputError(where, "a perez sky without weather", "its clearness and brightness");
    const auto& w = *sky.weather;
    if (!(w.clearness >= 1) || std::isinf(w.clearness))
      throw InputError(where, "clearness " + std::to_string(w.clearness), "a finite number of 1 or more");
    if (!(w.brightness > 0) || std::isinf(w.brightness))
      throw InputError(where, "brightness " + std::to_string(w.brightness), "a finite number above 0");
    sky.shape = perez_shape(w, std::acos(std::min(1.0, sky.sun->z)));
  }
  const auto value = [&](double cos_zenith, double cos_chi) {
    return sky.model == SkyModel::clear ? clear_sky(cos_zenith, cos_chi) : perez_luminance(sky.shape, cos_zenith, cos_chi);
  };
  // Midpoint rule in zenith angle and in azimuth from the sun, half of it by symmetry. In these variables the integrand is smooth
  // at zenith and horizon, but for the indicatrix's cusp at the sun: good to 1e-5.
  constexpr int rings = 256, sectors = 256;
  const double sun_cos = sky.sun->z, sun_sin = std::sqrt(std::max(0.0, 1.0 - sun_cos * sun_cos));
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double zenith = (i + 0.5) * pi / (2 * rings), c = std::cos(zenith), s = std::sin(zenith);
    for (int j = 0; j < sectors; ++j) sum += s * c * value(c, c * sun_cos + s * sun_sin * std::cos((j + 0.5) * pi / sectors));
  }
  if (!(sum > 0.0)) throw InputError(where, "weather whose perez sky is dark", "another clearness or brightness");
  sky.normalisation = rings * sectors / (pi * pi * sum);
}

}  // namespace sunfleck
