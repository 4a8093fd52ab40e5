// Sky models: normalisation, shape, names, errors.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/sky.hpp>
#include <sunfleck/light/sun.hpp>

using namespace sunfleck;

namespace {

/// Integral of r(d) cos(z) over the upper hemisphere, midpoint rule on n x n.
double horizontal_irradiance(const Sky& sky, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double zenith = (i + 0.5) * std::numbers::pi / (2 * n), s = std::sin(zenith), c = std::cos(zenith);
    for (int j = 0; j < n; ++j) {
      const double azimuth = (j + 0.5) * 2 * std::numbers::pi / n;
      sum += s * c * sky.relative_radiance({s * std::cos(azimuth), s * std::sin(azimuth), c});
    }
  }
  return sum * std::numbers::pi * std::numbers::pi / (double(n) * n);
}

}  // namespace

TEST_CASE("every sky brings irradiance 1 to a horizontal plane") {
  for (const auto& name : sky_model_names())
    for (const double elevation : {3.0, 35.0, 90.0}) {
      Sky sky;
      sky.model = *sky_model_from_name(name);
      sky.sun = direction_from_angles(elevation, 200.0);
      prepare_sky(sky, "sky");
      CAPTURE(name, elevation);
      // both quadratures are limited by the cusp of the clear sky at the sun: about 1e-5 at these numbers of points
      CHECK(horizontal_irradiance(sky, 500) == Approx(1.0).epsilon(2e-5));
    }
}

TEST_CASE("a vertical plate under the standard overcast sky gets .396 of the horizontal irradiance") {
  Sky sky;
  sky.model = SkyModel::standard_overcast;
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double z = (i + 0.5) / n, azimuth = (j + 0.5) * std::numbers::pi / n, s = std::sqrt(1 - z * z);
      sum += sky.relative_radiance({s * std::cos(azimuth), s * std::sin(azimuth), z}) * s * std::sin(azimuth);
    }
  // closed form: 3/7 (1/2 + 4/(3 pi)) = .39618...
  CHECK(sum * std::numbers::pi / (double(n) * n) == Approx(3.0 / 7.0 * (0.5 + 4.0 / (3.0 * std::numbers::pi))).epsilon(1e-4));
}

TEST_CASE("skies are black below the horizon, but for the sphere") {
  for (const auto& name : sky_model_names()) {
    Sky sky;
    sky.model = *sky_model_from_name(name);
    sky.sun = Vec3{0, 0, 1};
    prepare_sky(sky, "sky");
    CHECK(sky.relative_radiance({0.6, 0, -0.8}) == (name == "sphere" ? 1.0 / std::numbers::pi : 0.0));
  }
}

TEST_CASE("the clear sky follows CIE S 011 type 12") {
  Sky sky;
  sky.model = SkyModel::clear;
  sky.sun = direction_from_angles(40.0, 90.0);
  prepare_sky(sky, "sky");
  // ratio of the zenith to the point opposite the sun at 40 degrees elevation, from the formula by hand
  const auto f = [](double chi) {
    return 1 + 10 * (std::exp(-3 * chi) - std::exp(-1.5 * std::numbers::pi)) + 0.45 * std::cos(chi) * std::cos(chi);
  };
  const double degree = std::numbers::pi / 180;
  const double expected = f(50 * degree) * (1 - std::exp(-0.32)) / (f(100 * degree) * (1 - std::exp(-0.32 / std::sin(40 * degree))));
  CHECK(sky.relative_radiance({0, 0, 1}) / sky.relative_radiance(direction_from_angles(40.0, 270.0)) == Approx(expected).epsilon(1e-12));
  CHECK(std::isfinite(sky.relative_radiance({1, 0, 1e-300})));
}

TEST_CASE("a clear sky needs a sun above the horizon") {
  Sky sky;
  sky.model = SkyModel::clear;
  CHECK_THROWS_WITH(
      prepare_sky(sky, "s.toml:4: sky.model"),
      "s.toml:4: sky.model: found a clear sky without a sun; expected a sun above the horizon, about which the clear sky is built");
  sky.sun = Vec3{1, 0, 0};
  CHECK_THROWS_AS(prepare_sky(sky, "sky"), InputError);
}

TEST_CASE("names of skies go both ways") {
  for (const auto& name : sky_model_names()) CHECK(name_of(*sky_model_from_name(name)) == name);
  CHECK_FALSE(sky_model_from_name("Uniform").has_value());
}
