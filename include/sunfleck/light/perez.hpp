// The all-weather sky of Perez, Seals & Michalsky 1993, doi:10.1016/0038-092X(93)90017-I, with its erratum (Solar Energy 51, 423).
#pragma once

#include <string>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Weather as the model knows it.
struct PerezWeather {
  double clearness = 1;   ///< epsilon, from 1 (overcast) up [-]
  double brightness = 0;  ///< Delta, of the diffuse light, about .01 to .6 [-]
};

/// Clearness and brightness from irradiances of all wavelengths [W m^-2] (Perez et al. 1990, doi:10.1016/0038-092X(90)90055-H):
///     epsilon = ((D + I) / D + 1.041 Z^3) / (1 + 1.041 Z^3),   Delta = D m / I0,
/// D diffuse on a horizontal plane, I the beam on a plane that faces the sun, Z the sun's zenith angle [rad], m the air mass (Kasten 1966),
/// I0 what arrives outside the atmosphere: 1367 W m^-2, for a day of the year from 1 to 366 times 1 + .033 cos(2 pi day / 365), for 0 in
/// the mean of the year. Throws InputError(where) if D is not above zero, I below it, or either is not finite; a sun lower than the horizon
/// counts as at it.
PerezWeather perez_weather(double direct, double diffuse, double sun_elevation_deg, int day_of_year, const std::string& where);

/// Parameters of the luminance: a, b gradation; c, d about the sun; e scattered back.
struct PerezShape {
  double a = 0, b = 0, c = 0, d = 0, e = 0;
};

/// From the paper's table of eight bins of clearness; `zenith` of the sun [rad]. As Radiance's gendaylit has it, the brightness is kept
/// within .01 and .6, and at .2 or more between clearness 1.065 and 2.8: the range of the weather that the table was fitted to. Where b
/// would be above zero even so, and the horizon without measure, it is 0.
PerezShape perez_shape(const PerezWeather& weather, double zenith);

/// Luminance towards the cosine of a zenith angle, above 0, at a cosine of the angle chi to the sun [rad], without its constant factor:
///     (1 + a exp(b / cos zenith)) (1 + c exp(d chi) + e cos^2 chi), zero where that is negative.
double perez_luminance(const PerezShape& shape, double cos_zenith, double cos_chi);

}  // namespace sunfleck
