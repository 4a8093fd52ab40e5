#include <catch2/catch.hpp>

#include <limits>

#include <sunfleck/core/similarity.hpp>

using namespace sunfleck;

namespace {

/// A turn about a slanted axis (quarter turns and 0.3 rad), as three of a rotation's factors.
Mat3 slanted_turn() {
  const Mat3 over{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}};
  return Affine::turn(0.3).linear * over * Affine::turn(1.1).linear;
}

}  // namespace

TEST_CASE("A similarity and its affine map agree, there and back", "[core]") {
  for (const bool mirror : {false, true}) {
    Mat3 turn = slanted_turn();
    if (mirror) turn[1] = -turn[1];
    const auto found = similarity_of({0.02 * turn, {5, -3, 2}});
    REQUIRE(found);
    CHECK(found->scale == Approx(0.02).epsilon(1e-14));
    CHECK(found->affine().mirrors() == mirror);
    const Vec3 p{1, 2, 3}, d{0.6, 0, 0.8};
    // a few roundings of coordinates below 10
    CHECK(glm::length(found->affine().point(p) - found->point(p)) < 1e-14);
    CHECK(glm::length(found->point(p) - (0.02 * (turn * p) + Vec3{5, -3, 2})) < 1e-14);
    CHECK(glm::length(found->point_back(found->point(p)) - p) < 1e-12);  // divided by the scale
    CHECK(glm::length(found->direction_back(found->direction(d)) - d) < 1e-14);
    CHECK(glm::length(found->direction(d)) == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("A map that stretches, shears, flattens or is not finite is no similarity", "[core]") {
  Mat3 stretched = slanted_turn();
  stretched[2] *= 1 + 2e-6;
  CHECK_FALSE(similarity_of({stretched, Vec3{0}}));
  CHECK(similarity_of({stretched, Vec3{0}}, 1e-5));
  stretched[2] /= 1 + 2e-6;
  CHECK(similarity_of({stretched, Vec3{0}}, 1e-9));
  CHECK_FALSE(similarity_of({Mat3{Vec3{1, 0, 0}, Vec3{1e-3, 1, 0}, Vec3{0, 0, 1}}, Vec3{0}}));
  CHECK_FALSE(similarity_of({Mat3{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 0}}, Vec3{0}}));
  CHECK_FALSE(similarity_of({Mat3{std::numeric_limits<double>::infinity()}, Vec3{0}}));
  CHECK_FALSE(similarity_of({Mat3{std::numeric_limits<double>::quiet_NaN()}, Vec3{0}}));
}
