// The all-weather sky of Perez, Seals & Michalsky 1993.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/sky.hpp>
#include <sunfleck/light/sun.hpp>

using namespace sunfleck;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Relative luminance at (zenith angle, azimuth from the sun) = (0, 0), (30, 0), (60, 90), (80, 180), (89, 45) [degrees].
struct Published {
  double clearness, brightness, sun_zenith_deg;
  std::array<double, 5> luminance;
};

/// As Radiance's gendaylit has it (calc_rel_lum_perez of Delaunay 1994), six digits: one weather a bin of clearness, two suns each.
constexpr Published published[] = {
    {1.03, 0.12, 25, {2.03945, 2.00787, 1.6433, 1.23443, 1.23129}},   {1.03, 0.12, 60, {1.85187, 1.84799, 1.55617, 1.17309, 1.27422}},
    {1.15, 0.3, 25, {3.14077, 6.49197, 1.58911, 1.13785, 1.50848}},   {1.15, 0.3, 60, {0.907725, 2.13293, 1.09859, 1.08983, 1.91209}},
    {1.35, 0.35, 25, {2.67312, 7.30549, 1.1928, 1.03029, 1.17747}},   {1.35, 0.35, 60, {0.944992, 2.26837, 1.05758, 1.0601, 1.75121}},
    {1.7, 0.38, 25, {3.05312, 7.45874, 1.3282, 1.05734, 1.25709}},    {1.7, 0.38, 60, {0.932813, 2.291, 1.05332, 1.04786, 1.76916}},
    {2.3, 0.33, 25, {2.89453, 7.80917, 1.31302, 1.04731, 1.28395}},   {2.3, 0.33, 60, {0.868706, 2.13285, 1.00192, 1.01052, 1.72951}},
    {3.6, 0.25, 25, {2.08772, 6.08865, 0.945891, 0.992311, 1.16258}}, {3.6, 0.25, 60, {0.657237, 1.66493, 0.718311, 1.05751, 1.74762}},
    {5.3, 0.18, 25, {1.10544, 3.64608, 0.526935, 0.768762, 1.18371}}, {5.3, 0.18, 60, {0.349013, 0.913641, 0.488188, 1.03333, 1.61025}},
    {7, 0.12, 25, {0.826082, 3.49093, 0.44364, 0.724632, 1.17079}},   {7, 0.12, 60, {0.235293, 0.564741, 0.282625, 0.846383, 1.60033}}};

Vec3 at(double zenith_deg, double azimuth_deg) {
  return direction_from_angles(90 - zenith_deg, azimuth_deg);
}

Sky perez(double clearness, double brightness, double sun_zenith_deg) {
  Sky sky;
  sky.model = SkyModel::perez;
  sky.sun = at(sun_zenith_deg, 0);
  sky.weather = PerezWeather{clearness, brightness};
  prepare_sky(sky, "sky");
  return sky;
}

/// Gauss-Legendre in neither variable: midpoints in the cosine of the zenith angle, other points than those of the normalisation.
double horizontal_irradiance(const Sky& sky) {
  constexpr int n = 1000;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double z = (i + 0.5) / n, s = std::sqrt(1 - z * z), a = 2 * std::numbers::pi * (j + 0.25) / n;
      sum += z * sky.relative_radiance({s * std::cos(a), s * std::sin(a), z});
    }
  return sum * 2 * std::numbers::pi / (double(n) * n);
}

}  // namespace

TEST_CASE("The luminance of Perez's eight bins of clearness is as published", "[light][sky]") {
  constexpr double zeniths[] = {0, 30, 60, 80, 89}, azimuths[] = {0, 0, 90, 180, 45};
  for (const auto& row : published) {
    const Sky sky = perez(row.clearness, row.brightness, row.sun_zenith_deg);
    const PerezShape shape = perez_shape({row.clearness, row.brightness}, row.sun_zenith_deg * degree);
    for (std::size_t k = 0; k < 5; ++k) {
      CAPTURE(row.clearness, row.sun_zenith_deg, k);
      const Vec3 d = at(zeniths[k], azimuths[k]);
      CHECK(perez_luminance(shape, d.z, glm::dot(d, *sky.sun)) == Approx(row.luminance[k]).epsilon(1e-5));  // six digits; there in float
      CHECK(sky.relative_radiance(d) / sky.relative_radiance({0, 0, 1}) == Approx(row.luminance[k] / row.luminance[0]).epsilon(1e-5));
    }
    CHECK(horizontal_irradiance(sky) == Approx(1.0).epsilon(2e-4));
    CHECK(sky.relative_radiance({0.6, 0, -0.8}) == 0.0);
  }
}

TEST_CASE("Perez's sky is finite, dark nowhere else than it may be, and of irradiance 1 for all weather", "[light][sky]") {
  for (const double clearness : {1.0, 1.0649, 1.065, 1.2, 1.49, 1.94, 2.79, 4.4, 6.1, 12.0, 1000.0})
    for (const double brightness : {1e-9, 0.01, 0.05, 0.2, 0.6, 40.0})
      for (const double zenith : {0.0, 20.0, 50.0, 75.0, 89.9}) {
        if (clearness > 2.8 && brightness < 0.05) continue;  // no such weather: a clear sky scatters more than that
        CAPTURE(clearness, brightness, zenith);
        const Sky sky = perez(clearness, brightness, zenith);
        double sum = 0;
        for (int i = 0; i < 64; ++i)
          for (int j = 0; j < 64; ++j) {
            const double r = sky.relative_radiance(at(90 * (i + 0.5) / 64, 360 * (j + 0.5) / 64));
            REQUIRE(r >= 0);
            REQUIRE(std::isfinite(r));
            sum += r * std::sin(std::numbers::pi * (i + 0.5) / 64);
          }
        // 4096 points: what narrow peaks about the sun leave
        CHECK(sum * std::numbers::pi * std::numbers::pi / 2 / 4096 == Approx(1.0).epsilon(0.02));
        CHECK(std::isfinite(sky.relative_radiance({1, 0, 1e-300})));
      }
}

TEST_CASE("Weather that the formula has no light for is refused", "[light][sky]") {
  CHECK_THROWS_WITH(perez(4.4, 0.01, 0), "sky: found weather whose perez sky is dark; expected another clearness or brightness");
}

TEST_CASE("Clearness and brightness follow from direct and diffuse irradiance", "[light][sky]") {
  // by hand: Z = 60 degrees, 1.041 Z^3 = 1.19544, air mass 1 / (.5 + .15 x 33.885^-1.253) = 1.99284
  const PerezWeather w = perez_weather(600, 100, 30, 0, "sky");
  CHECK(w.clearness == Approx((7 + 1.19544) / 2.19544).epsilon(1e-5));
  CHECK(w.brightness == Approx(100 * 1.99284 / 1367).epsilon(1e-4));
  CHECK(perez_weather(0, 50, 40, 0, "sky").clearness == Approx(1.0));
  CHECK(perez_weather(600, 100, 30, 3, "sky").brightness / w.brightness == Approx(1 / (1 + 0.033 * std::cos(6 * std::numbers::pi / 365))));
  CHECK_THROWS_WITH(perez_weather(1, 0, 30, 0, "s.toml:4: sky"),
                    "s.toml:4: sky: found diffuse 0.000000; expected a diffuse irradiance above zero [W m^-2]");
  CHECK_THROWS_AS(perez_weather(-1, 10, 30, 0, "sky"), InputError);
  CHECK_THROWS_AS(perez_weather(NAN, 10, 30, 0, "sky"), InputError);
  CHECK_THROWS_AS(perez_weather(1, INFINITY, 30, 0, "sky"), InputError);
}

TEST_CASE("A Perez sky needs weather and a sun above the horizon", "[light][sky]") {
  Sky sky;
  sky.model = SkyModel::perez;
  CHECK_THROWS_WITH(prepare_sky(sky, "sky"),
                    "sky: found a perez sky without a sun; expected a sun above the horizon, about which the perez sky is built");
  sky.sun = Vec3{0, 0, 1};
  CHECK_THROWS_WITH(prepare_sky(sky, "sky"), "sky: found a perez sky without weather; expected its clearness and brightness");
  sky.weather = PerezWeather{0.5, 0.1};
  CHECK_THROWS_WITH(prepare_sky(sky, "sky"), Catch::Contains("clearness 0.5"));
  sky.weather = PerezWeather{NAN, 0.1};
  CHECK_THROWS_AS(prepare_sky(sky, "sky"), InputError);
  sky.weather = PerezWeather{2, 0};
  CHECK_THROWS_WITH(prepare_sky(sky, "sky"), Catch::Contains("brightness 0.0"));
}
