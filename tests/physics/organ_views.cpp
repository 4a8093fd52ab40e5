// View factors of organs towards sky and ground, against closed forms.
#include <catch2/catch.hpp>

#include <sunfleck/solver/organ_views.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

Scene black() {
  return scene_with({"PAR"}, {uniform_optics("leaf", {0}, {0})});
}

constexpr double error = 3 * 0.5 / 64;  // three standard errors of 4,096 rays

}  // namespace

TEST_CASE("views: a leaf over wide ground sees the sky above and the ground below; an upright one half of each", "[views]") {
  Scene scene = black();
  scene.ground = flat_ground({2000, 2000}, {0, 0}, {2, 2}, {0});
  add(scene, "level", {square(0.5)}, 0);
  add(scene, "upright", {Mesh{{{30, 0, 0.2}, {31, 0, 0.2}, {31, 0, 1.2}}, {{0, 1, 2}}}}, 0);
  const auto views = organ_views(scene, 4096);
  REQUIRE(views.count == 2 + 4);
  CHECK(views.sky[0] == 1.0);
  CHECK(views.ground[0] == 0.0);
  CHECK(views.sky[1] == 0.0);
  CHECK(views.ground[1] == Approx(1.0).margin(1e-6));
  for (int side : {2, 3}) {
    CHECK(views.sky[side] == Approx(0.5).margin(error));
    CHECK(views.ground[side] == Approx(0.5).margin(error));
  }
  CHECK(views.sky[4] == Approx(1.0).margin(1e-3));  // the ground's own cells
}

TEST_CASE("views: a square under another, a side apart, sees it by the view factor .19982", "[views]") {
  Scene scene = black();  // Incropera and DeWitt, aligned parallel rectangles
  add(scene, "lower", {square(0)}, 0);
  add(scene, "upper", {square(1)}, 0);
  const auto views = organ_views(scene, 4096);
  CHECK(views.sky[0] == Approx(1 - 0.19982).margin(error));
  CHECK(views.sky[2] == 1.0);
  CHECK(views.ground == std::vector<double>(4, 0.0));
}

TEST_CASE("views: an endless floor of leaves hides the ground, and a gap of half of it half", "[views]") {
  Scene scene = black();
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {1, 1}, {0});
  add(scene, "floor", {square(1e-4)}, 0);
  add(scene, "leaf", {square(3, 0.1)}, 0);
  const auto closed = organ_views(scene, 1024);
  CHECK(closed.ground[3] == 0.0);
  scene.plants[0].placements[0].map = Affine{Mat3{Vec3{0.5, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, Vec3{0.0}};
  const auto half = organ_views(scene, 4096);
  CHECK(half.ground[3] == Approx(0.5).margin(error + 0.02));  // the leaf's own images hide a little of either
}
