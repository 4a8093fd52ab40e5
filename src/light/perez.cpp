#include <sunfleck/light/perez.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>

#include <light/angles.hpp>

namespace sunfleck {

namespace {

constexpr int bins = 8;
/// Clearness at which the next bin begins.
constexpr double bin_ends[bins - 1] = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

/// x1, x2, x3, x4 of a parameter: x1 + x2 Z + Delta (x3 + x4 Z).
struct Row {
  double x[4];
  double at(double zenith, double brightness) const { return x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith); }
};

/// Table 1 of the paper: a, b, c, d, e of each bin.
constexpr Row table[bins][5] = {{{{1.3525, -0.2576, -0.2690, -1.4366}},
                                 {{-0.7670, 0.0007, 1.2734, -0.1233}},
                                 {{2.8000, 0.6004, 1.2375, 1.0000}},
                                 {{1.8734, 0.6297, 0.9738, 0.2809}},
                                 {{0.0356, -0.1246, -0.5718, 0.9938}}},
                                {{{-1.2219, -0.7730, 1.4148, 1.1016}},
                                 {{-0.2054, 0.0367, -3.9128, 0.9156}},
                                 {{6.9750, 0.1774, 6.4477, -0.1239}},
                                 {{-1.5798, -0.5081, -1.7812, 0.1080}},
                                 {{0.2624, 0.0672, -0.2190, -0.4285}}},
                                {{{-1.1000, -0.2515, 0.8952, 0.0156}},
                                 {{0.2782, -0.1812, -4.5000, 1.1766}},
                                 {{24.7219, -13.0812, -37.7000, 34.8438}},
                                 {{-5.0000, 1.5218, 3.9229, -2.6204}},
                                 {{-0.0156, 0.1597, 0.4199, -0.5562}}},
                                {{{-0.5484, -0.6654, -0.2672, 0.7117}},
                                 {{0.7234, -0.6219, -5.6812, 2.6297}},
                                 {{33.3389, -18.3000, -62.2500, 52.0781}},
                                 {{-3.5000, 0.0016, 1.1477, 0.1062}},
                                 {{0.4659, -0.3296, -0.0876, -0.0329}}},
                                {{{-0.6000, -0.3566, -2.5000, 2.3250}},
                                 {{0.2937, 0.0496, -5.6812, 1.8415}},
                                 {{21.0000, -4.7656, -21.5906, 7.2492}},
                                 {{-3.5000, -0.1554, 1.4062, 0.3988}},
                                 {{0.0032, 0.0766, -0.0656, -0.1294}}},
                                {{{-1.0156, -0.3670, 1.0078, 1.4051}},
                                 {{0.2875, -0.5328, -3.8500, 3.3750}},
                                 {{14.0000, -0.9999, -7.1406, 7.5469}},
                                 {{-3.4000, -0.1078, -1.0750, 1.5702}},
                                 {{-0.0672, 0.4016, 0.3017, -0.4844}}},
                                {{{-1.0000, 0.0211, 0.5025, -0.5119}},
                                 {{-0.3000, 0.1922, 0.7023, -1.6317}},
                                 {{19.0000, -5.0000, 1.2438, -1.9094}},
                                 {{-4.0000, 0.0250, 0.3844, 0.2656}},
                                 {{1.0468, -0.3788, -2.4517, 1.4656}}},
                                {{{-1.0500, 0.0289, 0.4260, 0.3590}},
                                 {{-0.3250, 0.1156, 0.7781, 0.0025}},
                                 {{31.0625, -14.5000, -46.1148, 55.3750}},
                                 {{-7.2312, 0.4050, 13.3500, 0.6234}},
                                 {{1.5000, -0.6426, 1.8564, 0.5636}}}};

double eccentricity(int day) {
  return day > 0 ? 1.0 + 0.033 * std::cos(2.0 * std::numbers::pi * day / 365.0) : 1.0;
}

}  // namespace

PerezWeather perez_weather(double direct, double diffuse, double sun_elevation_deg, int day_of_year, const std::string& where) {
  if (!(diffuse > 0) || std::isinf(diffuse))
    throw InputError(where, "diffuse " + std::to_string(diffuse), "a diffuse irradiance above zero [W m^-2]");
  if (!(direct >= 0) || std::isinf(direct))
    throw InputError(where, "direct " + std::to_string(direct), "a direct irradiance of zero or more [W m^-2]");
  const double elevation = std::clamp(sun_elevation_deg, 0.0, 90.0), zenith_deg = 90.0 - elevation;
  const double cube = 1.041 * std::pow(zenith_deg * degree, 3);
  const double air_mass = 1.0 / (std::sin(elevation * degree) + 0.15 * std::pow(93.885 - zenith_deg, -1.253));
  return {((diffuse + direct) / diffuse + cube) / (1.0 + cube), diffuse * air_mass / (1367.0 * eccentricity(day_of_year))};
}

PerezShape perez_shape(const PerezWeather& weather, double zenith) {
  int bin = 0;
  while (bin < bins - 1 && weather.clearness >= bin_ends[bin]) ++bin;
  double brightness = std::clamp(weather.brightness, 0.01, 0.6);
  if (weather.clearness > 1.065 && weather.clearness < 2.8) brightness = std::max(brightness, 0.2);
  const auto& rows = table[bin];
  const auto at = [&](int row) { return rows[row].at(zenith, brightness); };
  PerezShape shape{at(0), std::min(0.0, at(1)), at(2), at(3), at(4)};
  if (bin == 0) {  // of their own form
    const auto &c = rows[2].x, &d = rows[3].x;
    shape.c = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
    shape.d = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  }
  return shape;
}

double perez_luminance(const PerezShape& shape, double cos_zenith, double cos_chi) {
  const double cosine = std::clamp(cos_chi, -1.0, 1.0), chi = std::acos(cosine);
  const double gradation = 1.0 + shape.a * std::exp(shape.b / cos_zenith);  // towards the horizon the exponential ends at 0
  const double indicatrix = 1.0 + shape.c * std::exp(shape.d * chi) + shape.e * cosine * cosine;
  return std::max(0.0, gradation) * std::max(0.0, indicatrix);
}

}  // namespace sunfleck
