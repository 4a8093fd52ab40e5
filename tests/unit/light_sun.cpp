// The sun's direction from angles, and points of its disc.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/light/sun.hpp>

using namespace sunfleck;

TEST_CASE("azimuth runs from north over east") {
  const auto near = [](const Vec3& a, const Vec3& b) { return glm::length(a - b) < 1e-15; };
  CHECK(near(direction_from_angles(0, 0), {0, 1, 0}));
  CHECK(near(direction_from_angles(0, 90), {1, 0, 0}));
  CHECK(near(direction_from_angles(0, 180), {0, -1, 0}));
  CHECK(near(direction_from_angles(90, 123), {0, 0, 1}));
  CHECK(near(direction_from_angles(30, 270), {-std::sqrt(0.75), 0, 0.5}));
}

TEST_CASE("points of the sun's disc stand for the same solid angle each") {
  const double radius = 2 * std::numbers::pi / 180;
  const Sun sun{direction_from_angles(40, 70), {}, 4.0};
  const auto points = sun_disc(sun, 2000, 3);
  REQUIRE(points.size() == 2000);
  Vec3 mean{0.0};
  int inner = 0;
  for (const auto& p : points) {
    CHECK(glm::length(p) == Approx(1));
    const double angle = std::acos(glm::dot(p, sun.direction));
    CHECK(angle <= radius * (1 + 1e-9));
    inner += angle < radius / 2;
    mean += p / 2000.0;
  }
  CHECK(inner == Approx(500).margin(2));  // a quarter of the disc; the spiral's rings are thinner than two points
  CHECK(std::acos(glm::dot(glm::normalize(mean), sun.direction)) < 0.01 * radius);
  for (const auto& p : sun_disc({{0, 0, 1}, {}, 0.0}, 3, 1)) CHECK(p == Vec3{0, 0, 1});
  CHECK(sun_disc(sun, 5, 3) == sun_disc(sun, 5, 3));
  CHECK(sun_disc(sun, 5, 3) != sun_disc(sun, 5, 4));
}

TEST_CASE("wide penumbrae of small leaves take more points of the sun's disc") {
  const double degree = std::numbers::pi / 180;
  const Sun sun{{0, 0, 1}, {}, 0.5}, point{{0, 0, 1}, {}, 0.0};
  CHECK(sun_disc_points(point, 8, 10, 1e-6) == 8);
  CHECK(sun_disc_points(sun, 8, 0, 1e-6) == 8);
  CHECK(sun_disc_points(sun, 8, 10, 0) == 8);  // nothing has an area
  // 10 m on, the penumbra is 8.7 cm wide: a leaf of a hundredth of a square metre is 10 cm
  CHECK(sun_disc_points(sun, 8, 10, 0.01) == std::lround(8 * (1 + 0.5 * degree * 10 / 0.1)));
  CHECK(sun_disc_points(sun, 8, 10, 1e-4) == std::lround(8 * (1 + 0.5 * degree * 10 / 0.01)));
  CHECK(sun_disc_points(sun, 4, 1e300, 1e-4) == 4 * 1001);  // a sun at the horizon of an endless field
}
