// Global radiation into direct and diffuse.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/split.hpp>

using namespace sunfleck;

namespace {
double outside(double elevation_deg, int day) {
  return 1370 * (1 + 0.033 * std::cos(2 * std::numbers::pi * day / 365)) * std::sin(elevation_deg * std::numbers::pi / 180);
}
}  // namespace

TEST_CASE("Spitters 1986: the four pieces of the diffuse share") {
  const double s0 = outside(60, 172);
  CHECK(split_global(0.10 * s0, 60, 172).diffuse == 1.0);
  CHECK(split_global(0.30 * s0, 60, 172).diffuse == Approx(1 - 6.4 * 0.08 * 0.08));
  CHECK(split_global(0.50 * s0, 60, 172).diffuse == Approx(1.47 - 1.66 * 0.5));
  const double sine = std::sin(std::numbers::pi / 3);
  CHECK(split_global(0.80 * s0, 60, 172).diffuse == Approx(0.847 - 1.61 * sine + 1.04 * sine * sine));
}

TEST_CASE("the diffuse share never rises as the sky clears, and shares add to 1") {
  for (const double elevation : {0.5, 5.0, 20.0, 45.0, 90.0}) {
    double last = 1.0;
    for (int i = 1; i <= 90; ++i) {
      const auto split = split_global(0.01 * i * outside(elevation, 80), elevation, 80);
      CHECK(split.diffuse <= last + 0.006);  // the paper's pieces meet with steps of at most .006 (at clearness .35)
      CHECK(split.direct + split.diffuse == Approx(1.0));
      CHECK(split.direct >= 0.0);
      last = split.diffuse;
    }
  }
}

TEST_CASE("the beam never exceeds what arrives outside the atmosphere") {
  const double global = 3.0 * outside(2.0, 10);
  const auto split = split_global(global, 2.0, 10);
  CHECK(split.direct * global <= outside(2.0, 10) * (1 + 1e-12));
  CHECK(split_global(100, -3, 10).diffuse == 1.0);
  CHECK(split_global(0, 30, 10).diffuse == 1.0);
}

TEST_CASE("global radiation that cannot be is refused") {
  CHECK_THROWS_WITH(split_global(-1, 30, 10, "s.toml:3: sky.global"),
                    "s.toml:3: sky.global: found -1.000000; expected a global irradiance of 0 or more [W m^-2]");
  CHECK_THROWS_AS(split_global(std::numeric_limits<double>::quiet_NaN(), 30, 10), InputError);
}
