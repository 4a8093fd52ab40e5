#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/view/camera.hpp>

using namespace sunfleck;

namespace {

std::vector<Vec3> cloud(double scale, const Vec3& offset) {
  RandomStream random(7);
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) {
    const double x = random.next(), y = random.next(), z = random.next();
    points.push_back(offset + scale * Vec3{2 * x, 0.5 * y, 3 * z});
  }
  return points;
}

}  // namespace

TEST_CASE("the default camera frames all points and touches the frame on two sides", "[view]") {
  for (const bool orthographic : {false, true})
    for (const double scale : {1e-3, 1.0, 1e4})
      for (const double elevation : {-90.0, -20.0, 0.0, 25.0, 90.0})
        for (const double aspect : {0.5, 1.6}) {
          const auto points = cloud(scale, {100, -50, 3});
          const Frame frame{0.1, 0.8, 0.05, 0.9};
          const Camera camera({.elevation_deg = elevation, .orthographic = orthographic}, points, aspect, frame);
          double left = 1, right = 0, top = 1, bottom = 0;
          for (const auto& p : points) {
            const auto at = camera.project(p);
            REQUIRE(at);
            left = std::min(left, (*at)[0]), right = std::max(right, (*at)[0]);
            top = std::min(top, (*at)[1]), bottom = std::max(bottom, (*at)[1]);
          }
          // 1e-5: rounding of coordinates 1e5 times as large as the cloud's.
          REQUIRE(left >= frame.left - 1e-5);
          REQUIRE(right <= frame.right + 1e-5);
          REQUIRE(top >= frame.top - 1e-5);
          REQUIRE(bottom <= frame.bottom + 1e-5);
          const bool wide = left == Approx(frame.left).margin(1e-5) && right == Approx(frame.right).margin(1e-5);
          const bool high = top == Approx(frame.top).margin(1e-5) && bottom == Approx(frame.bottom).margin(1e-5);
          REQUIRE((wide || high));
        }
}

TEST_CASE("a camera's rays and projections agree", "[view]") {
  for (const bool orthographic : {false, true}) {
    const Camera camera({.orthographic = orthographic}, cloud(1, {0, 0, 0}), 1.5);
    for (const double x : {0.0, 0.3, 1.0})
      for (const double y : {0.0, 0.7, 1.0}) {
        const auto ray = camera.ray(x, y);
        REQUIRE(glm::length(ray.direction) == Approx(1.0));
        const auto at = camera.project(ray.origin + 2.5 * ray.direction);
        REQUIRE(at);
        REQUIRE((*at)[0] == Approx(x).margin(1e-12));
        REQUIRE((*at)[1] == Approx(y).margin(1e-12));
      }
  }
}

TEST_CASE("the default camera stands in the south-south-east, above, and north is away", "[view]") {
  const Camera camera({}, cloud(1, {0, 0, 0}), 1.0);
  REQUIRE(camera.forward().x < 0);
  REQUIRE(camera.forward().y > 0);
  REQUIRE(camera.forward().z < 0);
  const Camera above({.azimuth_deg = 180, .elevation_deg = 90}, cloud(1, {0, 0, 0}), 1.0);
  REQUIRE((*above.project({1, 0.5, 0}))[1] < (*above.project({1, 0, 0}))[1]);  // north is at the top of the picture
}

TEST_CASE("eye and target are taken as given", "[view]") {
  const auto points = cloud(1, {0, 0, 0});
  const Camera given({.eye = Vec3{5, 5, 5}, .target = Vec3{1, 0, 1}}, points, 1.0);
  REQUIRE(given.eye() == Vec3{5, 5, 5});
  REQUIRE((*given.project({1, 0, 1}))[0] == Approx(0.5));
  const Camera target({.target = Vec3{1, 0, 1}}, points, 1.0);
  REQUIRE((*target.project({1, 0, 1}))[0] == Approx(0.5));
  REQUIRE((*target.project({1, 0, 1}))[1] == Approx(0.5));
}

TEST_CASE("impossible cameras are refused", "[view]") {
  const std::vector<Vec3> none;
  REQUIRE_THROWS_WITH(Camera({.eye = Vec3{1, 1, 1}, .target = Vec3{1, 1, 1}}, none, 1.0),
                      "camera: found the same point as eye and target; expected two different points");
  REQUIRE_THROWS_WITH(Camera({.elevation_deg = 91}, none, 1.0), "--elevation: found 91; expected degrees in [-90, 90]");
  REQUIRE_THROWS_WITH(Camera({.field_of_view_deg = 0}, none, 1.0), "--fov: found 0; expected degrees above 0 and at most 170");
  REQUIRE_THROWS_AS(Camera({.eye = Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 0}}, none, 1.0), UsageError);
}
