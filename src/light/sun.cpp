#include <sunfleck/light/sun.hpp>

#include <cmath>
#include <span>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/time.hpp>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

constexpr double arc_second = degree / 3600.0;

/// One periodic term: a cos(b + c t), a in 1e-8, t in millennia from J2000.
struct Term {
  double a, b, c;
};

// The Earth's place: the terms of VSOP87 (Bretagnon & Francou 1988) that Reda & Andreas list in their table A4.2, those of the
// longitude from 1e-6 rad on and those of latitude and distance as far as an arc second needs them. What is left out adds up to
// less than 0.0005 degrees.
constexpr Term longitude_0[] = {{175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
                                {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
                                {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
                                {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
                                {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
                                {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
                                {902, 2.045, 26.298},        {857, 3.508, 398.149},
                                {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
                                {505, 4.583, 18849.228},     {492, 4.205, 775.523},
                                {357, 2.92, 0.067},          {317, 5.849, 11790.629},
                                {284, 1.899, 796.298},       {271, 0.315, 10977.079},
                                {243, 0.345, 5486.778},      {206, 4.806, 2544.314},
                                {205, 1.869, 5573.143},      {202, 2.458, 6069.777},
                                {156, 0.833, 213.299},       {132, 3.411, 2942.463},
                                {126, 1.083, 20.775},        {115, 0.645, 0.98},
                                {103, 0.636, 4694.003},      {102, 0.976, 15720.839},
                                {102, 4.267, 7.114},         {99, 6.21, 2146.17},
                                {98, 0.68, 155.42}};
constexpr Term longitude_1[] = {{628331966747.0, 0, 0},     {206059, 2.678235, 6283.07585},
                                {4303, 2.6351, 12566.1517}, {425, 1.59, 3.523},
                                {119, 5.796, 26.298},       {109, 2.966, 1577.344},
                                {93, 2.59, 18849.23},       {72, 1.14, 529.69},
                                {68, 1.87, 398.15},         {67, 4.41, 5507.55},
                                {59, 2.89, 5223.69},        {56, 2.17, 155.42}};
constexpr Term longitude_2[] = {{52919, 0, 0}, {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}, {27, 0.05, 3.52}};
constexpr Term longitude_3[] = {{289, 5.844, 6283.076}, {35, 0, 0}, {17, 5.49, 12566.15}};
constexpr Term longitude_4[] = {{114, 3.142, 0}, {8, 4.13, 6283.08}};
constexpr Term latitude_0[] = {{280, 3.199, 84334.662}, {102, 5.422, 5507.553}, {80, 3.88, 5223.69}, {44, 3.7, 2352.87}, {32, 4, 1577.34}};
constexpr Term distance_0[] = {{100013989, 0, 0}, {1670700, 3.0984635, 6283.07585}, {13956, 3.05525, 12566.1517}};
constexpr Term distance_1[] = {{103019, 1.10749, 6283.07585}};

double sum(std::span<const Term> terms, double t) {
  double total = 0;
  for (const auto& term : terms) total += term.a * std::cos(term.b + term.c * t);
  return total * 1e-8;
}

/// Largest terms of the IAU 1980 nutation (table A4.3): multiples of the five arguments, sine of longitude and its change per
/// century, cosine of obliquity and its change [1e-4 arc seconds]. The rest is below 0.02 arc seconds.
struct NutationTerm {
  int y[5];
  double a, b, c, d;
};
constexpr NutationTerm nutation[] = {{{0, 0, 0, 0, 1}, -171996, -174.2, 92025, 8.9}, {{-2, 0, 0, 2, 2}, -13187, -1.6, 5736, -3.1},
                                     {{0, 0, 0, 2, 2}, -2274, -0.2, 977, -0.5},      {{0, 0, 0, 0, 2}, 2062, 0.2, -895, 0.5},
                                     {{0, 1, 0, 0, 0}, 1426, -3.4, 54, -0.1},        {{0, 0, 1, 0, 0}, 712, 0.1, -7, 0},
                                     {{-2, 1, 0, 2, 2}, -517, 1.2, 224, -0.6},       {{0, 0, 0, 2, 1}, -386, -0.4, 200, 0},
                                     {{0, 0, 1, 2, 2}, -301, 0, 129, -0.1},          {{-2, -1, 0, 2, 2}, 217, -0.5, -95, 0.3}};

template <std::size_t n>
double polynomial(const double (&coefficients)[n], double x) {
  double value = 0;
  for (std::size_t i = n; i-- > 0;) value = value * x + coefficients[i];
  return value;
}

/// Dynamical time less universal time [s]: the long-term parabola of Espenak & Meeus 2006. Within a minute of what was observed
/// since 1800, and a minute is worth 0.0007 degrees.
double delta_t(double julian_date) {
  const double centuries_from_1820 = (julian_date - 2385800.5) / 36525.0;
  return -20.0 + 32.0 * centuries_from_1820 * centuries_from_1820;
}

}  // namespace

Vec3 direction_from_angles(double elevation_deg, double azimuth_deg) {
  const double horizontal = std::cos(elevation_deg * degree);
  return {horizontal * std::sin(azimuth_deg * degree), horizontal * std::cos(azimuth_deg * degree), std::sin(elevation_deg * degree)};
}

SolarPosition solar_position(const std::string& iso_time, double latitude_deg, double longitude_deg, double altitude_m,
                             const std::string& where) {
  const auto need = [&](bool fine, const char* name, double value, const char* expected) {
    if (!fine) throw InputError(where, name + (" = " + std::to_string(value)), expected);
  };
  need(std::abs(latitude_deg) <= 90.0, "latitude", latitude_deg, "degrees north within [-90, 90]");
  need(std::abs(longitude_deg) <= 360.0, "longitude", longitude_deg, "degrees east within [-360, 360]");
  need(std::abs(altitude_m) <= 1e5, "altitude", altitude_m, "metres above sea level within [-100000, 100000]");

  // Steps and symbols of Reda & Andreas, sections 3.1 to 3.14.
  const double jd = parse_time(iso_time, where).julian_date;
  const double days = jd - 2451545.0, century = days / 36525.0;
  const double ephemeris_century = (days + delta_t(jd) / 86400.0) / 36525.0, t = ephemeris_century / 10.0;

  const double longitude =
      sum(longitude_0, t) + t * (sum(longitude_1, t) + t * (sum(longitude_2, t) + t * (sum(longitude_3, t) + t * sum(longitude_4, t))));
  const double beta = -sum(latitude_0, t);
  const double distance = sum(distance_0, t) + t * sum(distance_1, t);  // [AU]

  const double x[5] = {polynomial({297.85036, 445267.111480, -0.0019142, 1.0 / 189474}, ephemeris_century) * degree,
                       polynomial({357.52772, 35999.050340, -0.0001603, -1.0 / 300000}, ephemeris_century) * degree,
                       polynomial({134.96298, 477198.867398, 0.0086972, 1.0 / 56250}, ephemeris_century) * degree,
                       polynomial({93.27191, 483202.017538, -0.0036825, 1.0 / 327270}, ephemeris_century) * degree,
                       polynomial({125.04452, -1934.136261, 0.0020708, 1.0 / 450000}, ephemeris_century) * degree};
  double in_longitude = 0, in_obliquity = 0;
  for (const auto& term : nutation) {
    double argument = 0;
    for (int i = 0; i < 5; ++i) argument += term.y[i] * x[i];
    in_longitude += (term.a + term.b * ephemeris_century) * std::sin(argument);
    in_obliquity += (term.c + term.d * ephemeris_century) * std::cos(argument);
  }
  in_longitude *= 1e-4 * arc_second;
  in_obliquity *= 1e-4 * arc_second;
  const double mean_obliquity =
      polynomial({84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67, -39.05, 7.12, 27.87, 5.79, 2.45}, t / 10.0) * arc_second;
  const double obliquity = mean_obliquity + in_obliquity;

  const double aberration = -20.4898 * arc_second / distance;
  const double lambda = longitude + std::numbers::pi + in_longitude + aberration;  // apparent, geocentric
  const double right_ascension =
      std::atan2(std::sin(lambda) * std::cos(obliquity) - std::tan(beta) * std::sin(obliquity), std::cos(lambda));
  const double declination = std::asin(std::sin(beta) * std::cos(obliquity) + std::cos(beta) * std::sin(obliquity) * std::sin(lambda));
  const double sidereal = polynomial({280.46061837 + 360.98564736629 * days, 0.0, 0.000387933, -1.0 / 38710000}, century) * degree +
                          in_longitude * std::cos(obliquity);
  const double hour_angle = sidereal + longitude_deg * degree - right_ascension;

  // Parallax: the observer stands on an ellipsoid, at a distance from its centre.
  const double phi = latitude_deg * degree, parallax = 8.794 * arc_second / distance;
  const double u = std::atan2(0.99664719 * std::sin(phi), std::cos(phi));
  const double across = std::cos(u) + altitude_m / 6378140.0 * std::cos(phi),
               along = 0.99664719 * std::sin(u) + altitude_m / 6378140.0 * std::sin(phi);
  const double denominator = std::cos(declination) - across * std::sin(parallax) * std::cos(hour_angle);
  const double shift = std::atan2(-across * std::sin(parallax) * std::sin(hour_angle), denominator);
  const double local_declination = std::atan2((std::sin(declination) - along * std::sin(parallax)) * std::cos(shift), denominator);
  const double local_hour_angle = hour_angle - shift;

  const double elevation =
      std::asin(std::sin(phi) * std::sin(local_declination) + std::cos(phi) * std::cos(local_declination) * std::cos(local_hour_angle));
  const double from_south =
      std::atan2(std::sin(local_hour_angle), std::cos(local_hour_angle) * std::sin(phi) - std::tan(local_declination) * std::cos(phi));
  double azimuth = std::fmod(from_south / degree + 180.0, 360.0);
  if (azimuth < 0.0) azimuth += 360.0;
  return {elevation / degree, azimuth};
}

}  // namespace sunfleck
