// The sun's direction from angles.
#include <catch2/catch.hpp>

#include <cmath>

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
