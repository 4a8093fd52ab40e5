// Direct and diffuse light from measured global radiation.
#pragma once

namespace sunfleck {

/// Shares of the global irradiance on a horizontal plane; direct + diffuse = 1.
struct GlobalSplit {
  double direct = 0;   ///< share of the sun's beam, on the horizontal plane [-]
  double diffuse = 1;  ///< share of the sky [-]
};

/// Splits hourly global solar radiation (all wavelengths, horizontal) [W m^-2] by its ratio to what arrives outside the atmosphere:
/// Spitters, Toussaint & Goudriaan 1986, eq. 20 a-d, doi:10.1016/0168-1923(86)90060-2 (solar constant 1370 W m^-2, as there).
/// The shares may be applied band by band; the beam on a plane that faces the sun is direct / sin(elevation) x the band's global.
/// Differs from the paper in two corners: at or below the horizon all is diffuse, and the beam never exceeds what arrives outside
/// the atmosphere (the paper's rule would, for a low sun); the excess is diffuse. Global radiation that is negative or not finite
/// throws InputError(where ...). A day of year outside [1, 366] counts as the nearest within.
GlobalSplit split_global(double global_irradiance, double elevation_deg, int day_of_year, const char* where = "global");

}  // namespace sunfleck
