// The sun's position against published values, and times.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/light/time.hpp>

using namespace sunfleck;

TEST_CASE("solar position: the example of Reda & Andreas 2004, table A5.1") {
  const auto sun = solar_position("2003-10-17T12:30:30-07:00", 39.742476, -105.1786, 1830.14, "sun");
  // the report gives e0 = 39.872046 before refraction and 39.888378 (zenith 50.11162) after it; azimuth 194.340241
  CHECK(sun.elevation_deg == Approx(39.872046).margin(0.001));
  CHECK(sun.azimuth_deg == Approx(194.340241).margin(0.001));
}

TEST_CASE("solar position: Meeus, Astronomical Algorithms, example 25.b, seen from the pole") {
  // 1992 October 13, 0 h dynamical time (59 s ahead of UTC): apparent declination -7.783871; at the pole that is the elevation, less
  // parallax
  const auto sun = solar_position("1992-10-12T23:59:01Z", 90.0, 0.0, 0.0, "sun");
  const double parallax = 8.794 / 3600.0 / 0.99760775 * std::cos(7.783871 * std::acos(-1.0) / 180.0) * 0.99664719;
  CHECK(sun.elevation_deg == Approx(-7.783871 - parallax).margin(0.001));
}

TEST_CASE("solar position does not depend on the zone in which the time is written") {
  const auto a = solar_position("2026-06-21T09:00:00+02:00", 43.6, 3.9, 0.0, "sun"),
             b = solar_position("2026-06-21T07:00Z", 43.6, 3.9, 0.0, "sun");
  CHECK(a.elevation_deg == b.elevation_deg);
  CHECK(a.azimuth_deg == b.azimuth_deg);
}

TEST_CASE("solar position: leap days, polar night and midnight sun") {
  // 29 February is the day between its neighbours: the declination rises by some .37 degrees a day
  const auto noon = [](const char* day) { return solar_position(std::string(day) + "T12:00:00Z", 51.5, 0.0, 0.0, "sun").elevation_deg; };
  const double before = noon("2024-02-28"), leap = noon("2024-02-29"), after = noon("2024-03-01");
  CHECK(leap - before == Approx(0.375).margin(0.02));
  CHECK(after - leap == Approx(0.375).margin(0.02));
  CHECK_THROWS_AS(noon("2023-02-29"), InputError);
  // Tromso: below the horizon all day at the winter solstice, above it all night at the summer solstice
  for (int hour = 0; hour < 24; ++hour) {
    const std::string time = (hour < 10 ? "T0" : "T") + std::to_string(hour) + ":00:00Z";
    CHECK(solar_position("2026-12-21" + time, 69.65, 18.96, 0.0, "sun").elevation_deg < -2.0);
    CHECK(solar_position("2026-06-21" + time, 69.65, 18.96, 0.0, "sun").elevation_deg > 2.0);
  }
}

TEST_CASE("places that do not exist are refused") {
  CHECK_THROWS_WITH(solar_position("2026-06-21T07:00Z", 91.0, 0.0, 0.0, "s.toml:8: sun"),
                    "s.toml:8: sun: found latitude = 91.000000; expected degrees north within [-90, 90]");
  CHECK_THROWS_AS(solar_position("2026-06-21T07:00Z", 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, "sun"), InputError);
}

TEST_CASE("times: Julian dates, days of the year, zones") {
  CHECK(parse_time("2000-01-01T12:00:00Z", "t").julian_date == 2451545.0);
  CHECK(parse_time("1999-01-01T00:00Z", "t").julian_date == 2451179.5);
  CHECK(parse_time("1987-06-19T12:00:00Z", "t").julian_date == 2446966.0);  // Meeus, chapter 7
  CHECK(parse_time("1600-12-31T00:00:00Z", "t").julian_date == 2305812.5);  // Meeus, chapter 7
  CHECK(parse_time("2003-10-17T12:30:30-07:00", "t").julian_date == Approx(2452930.312847).epsilon(1e-13));
  CHECK(parse_time("2024-12-31T23:30:00-05:00", "t").day_of_year == 366);
  CHECK(parse_time("2026-03-01T00:00:00.25+00:00", "t").day_of_year == 60);
}

TEST_CASE("times that are incomplete or do not exist are refused") {
  CHECK_THROWS_WITH(parse_time("2026-06-21T09:00:00", "s.toml:5: sun.time"),
                    "s.toml:5: sun.time: found \"2026-06-21T09:00:00\"; expected a time that exists, in ISO 8601 with its zone, such as "
                    "\"2026-06-21T09:00:00+02:00\" or \"2026-06-21T07:00:00Z\"");
  for (const char* bad :
       {"", "2026-06-21", "2026-02-29T00:00Z", "2026-13-01T00:00Z", "2026-06-00T00:00Z", "2026-06-21T24:00Z", "2026-06-21T09:60Z",
        "2026-06-21T09:00:60Z", "2026-06-21 09:00Z", "2026-06-21T9:00Z", "2026-06-21T09:00:00+2:00", "2026-06-21T09:00:00+02:60",
        "2026-06-21T09:00:00.Z", "2026-06-21T09:00:00Zx", "2026-06-21T09:00:00+25:00", "2026-00-21T09:00Z"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(parse_time(bad, "t"), InputError);
  }
}
