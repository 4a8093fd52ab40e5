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

const std::vector<std::string> names = {"uniform", "standard_overcast", "clear", "file", "sphere"};

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
  if (!(d.z > 0.0)) return 0.0;
  switch (model) {
    case SkyModel::standard_overcast:
      return 3.0 * (1.0 + 2.0 * d.z) / (7.0 * pi);
    case SkyModel::clear:
      return clear_normalisation * clear_sky(d.z, glm::dot(d, *sun));
    case SkyModel::file:
      return table ? table->relative_radiance(d) : 0.0;
    default:
      return 1.0 / pi;
  }
}

void prepare_sky(Sky& sky, const std::string& where) {
  if (sky.model == SkyModel::file && !sky.table)
    throw InputError(where, "a sky of directions without any", "a table of directions and radiances");
  if (sky.model != SkyModel::clear) return;
  if (!sky.sun) throw InputError(where, "a clear sky without a sun", "a sun above the horizon, about which the clear sky is built");
  if (!(sky.sun->z > 0.0))
    throw InputError(where, "a clear sky with the sun below the horizon", "a sun above the horizon, about which the clear sky is built");
  // Midpoint rule in zenith angle and in azimuth from the sun, half of it by symmetry. In these variables the integrand is smooth
  // at zenith and horizon, but for the indicatrix's cusp at the sun: good to 1e-5.
  constexpr int rings = 256, sectors = 256;
  const double sun_cos = sky.sun->z, sun_sin = std::sqrt(std::max(0.0, 1.0 - sun_cos * sun_cos));
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double zenith = (i + 0.5) * pi / (2 * rings), c = std::cos(zenith), s = std::sin(zenith);
    for (int j = 0; j < sectors; ++j) sum += s * c * clear_sky(c, c * sun_cos + s * sun_sin * std::cos((j + 0.5) * pi / sectors));
  }
  sky.clear_normalisation = rings * sectors / (pi * pi * sum);
}

}  // namespace sunfleck
