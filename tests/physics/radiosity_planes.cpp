// Radiosity: planes, plates and cavities with closed forms.
#include <catch2/catch.hpp>

#include <numbers>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

// Leaf and soil of the closed forms below.
constexpr double rho = 0.3912, tau = 0.4146, soil = 0.2142;

Scene planes_over_soil(const std::vector<double>& heights) {
  auto scene = scene_with({"red"}, {uniform_optics("leaf", {rho}, {tau})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {soil});
  std::vector<Mesh> planes;
  for (const double z : heights) planes.push_back(square(z));
  add(scene, "planes", std::move(planes), 0);
  return scene;
}

// Every line that leaves a plane meets the next one: counts, not samples, decide, so what is left are the tolerance of the iteration
// (2e-6) and single precision: ten thousand lines meet a cell here, in 400 directions of one weight each, whose sums round by up to
// 5e-4 / sqrt(12 * 400) of a line.
constexpr double exact = 4e-5;

}  // namespace

TEST_CASE("radiosity: a leaf plane over soil") {
  for (const auto method : both_methods)
    for (const bool sun : {false, true}) {
      auto scene = planes_over_soil({0.2});
      if (sun)
        point_sun(scene, {0.4, 0.2, 1}, std::sqrt(1.2));  // 1 on the horizontal
      else
        sky(scene, SkyModel::uniform, 1);
      const auto run = solve(scene, method);
      CAPTURE(name_of(method), sun);
      for (const std::size_t f : {0, 1}) CHECK(run.absorbed(f) == Approx(0.21302372).epsilon(exact));
      for (std::size_t f = 2; f < run.facets.size(); ++f) {
        CHECK(run.kept.on(f, 0) == Approx(0.45251883).epsilon(sun ? 2e-4 : exact));
        CHECK(run.kept.on(f, 1) == 0.0);
      }
      const auto& balance = run.report.balance[0][0];
      CHECK(balance.incident == Approx(1).epsilon(exact));
      CHECK(balance.escaped == Approx(0.43138698).epsilon(sun ? 2e-3 : exact));  // the sun's first reflection is counted line by line
      CHECK(std::abs(balance.residual()) < 1e-5);
    }
}

TEST_CASE("radiosity: three leaf planes over soil") {
  for (const auto method : both_methods) {
    auto scene = planes_over_soil({0.6, 0.4, 0.2});
    sky(scene, SkyModel::standard_overcast, 1);
    const auto run = solve(scene, method);
    CAPTURE(name_of(method));
    const double absorbed[] = {0.24183181, 0.12048213, 0.05424612};
    // a facet's lines fall on the directions of the sky a little unevenly; over a plane that evens out, and the lattice integrates the
    // overcast sky to 1e-4
    for (std::size_t f = 0; f < 6; ++f) CHECK(run.absorbed(f) == Approx(absorbed[f / 2]).epsilon(3e-3));
    for (std::size_t f = 0; f < 6; f += 2) CHECK(0.5 * (run.absorbed(f) + run.absorbed(f + 1)) == Approx(absorbed[f / 2]).epsilon(2e-4));
    for (std::size_t f = 6; f < run.facets.size(); ++f) CHECK(run.kept.on(f, 0) == Approx(0.11523314).epsilon(1e-3));
    CHECK(run.report.balance[0][0].escaped == Approx(0.49288974).epsilon(2e-4));
  }
}

TEST_CASE("radiosity: two leaves exactly on each other") {
  for (const auto method : both_methods) {
    auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0.06}, {0.04})});
    point_sun(scene, {0, 0, 1}, 100);
    add(scene, "leaves", {square(0), square(0)}, 0);
    const auto run = solve(scene, method);
    CAPTURE(name_of(method));
    // one of the two lies above; which one is the method's choice
    const std::size_t low = run.kept.on(0, 0) < run.kept.on(2, 0) ? 0 : 2, high = 2 - low;
    for (const std::size_t f : {0, 1}) {
      CHECK(run.kept.on(low + f, 0) == Approx(4.01445).epsilon(exact));
      CHECK(run.absorbed(low + f) == Approx(3.6130).epsilon(exact));
      CHECK(run.kept.on(low + f, 1) == Approx(0).margin(1e-6));
      CHECK(run.kept.on(high + f, 0) == Approx(100).epsilon(exact));
      CHECK(run.kept.on(high + f, 1) == Approx(100 * 0.04 * 0.06 / (1 - 0.06 * 0.06)).epsilon(exact));
    }
  }
}

TEST_CASE("radiosity: a closed cavity whose walls let light in") {
  // Walls under the sphere sky transmit .3 of the 1 W m^-2 that comes from everywhere: inside, B = emitted / (1 - rho).
  for (const auto method : both_methods) {
    auto scene = scene_with({"PAR"}, {{"wall", {0.2f}, {0.5f}, {0.3f}}});
    sky(scene, SkyModel::sphere, 1);
    const Vec3 p[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    const auto face = [&](int a, int b, int c, int d) { return Mesh{{p[a], p[b], p[c], p[d]}, {{0, 1, 2}, {0, 2, 3}}}; };
    add(scene, "walls", {face(0, 3, 2, 1), face(4, 5, 6, 7), face(0, 1, 5, 4), face(1, 2, 6, 5), face(2, 3, 7, 6), face(3, 0, 4, 7)}, 0);
    const auto run = solve(scene, method);
    double front = 0, back = 0;
    for (std::size_t f = 0; f < 12; ++f) {
      CAPTURE(name_of(method), f, run.kept.on(f, 0), run.kept.on(f, 1));
      // pixels that miss an edge let a line slip in or out: about 1 / (lines across a wall)
      CHECK(run.kept.on(f, 0) == Approx(1).epsilon(5e-3));
      CHECK(run.kept.on(f, 1) == Approx(0.3 / (1 - 0.5)).epsilon(5e-3));
      front += run.kept.on(f, 0) / 12;
      back += run.kept.on(f, 1) / 12;
    }
    CHECK(front == Approx(1).epsilon(1e-3));
    CHECK(back == Approx(0.6).epsilon(1e-3));
  }
}

TEST_CASE("radiosity: plates under each sky") {
  // where all is black the sky is projected; else the lines of scattered light bring it, here hardly any
  for (const auto& [method, reflectance] : {std::pair{both_methods[0], 0.0}, {both_methods[0], 1e-5}, {both_methods[1], 1e-5}})
    for (const auto model : {SkyModel::uniform, SkyModel::standard_overcast, SkyModel::clear, SkyModel::sphere}) {
      auto scene = scene_with({"PAR"}, {uniform_optics("plate", {reflectance}, {0})});
      sky(scene, model, 100);
      scene.states[0].sky->sun = direction_from_angles(40, 90);
      prepare_sky(*scene.states[0].sky, "sky");
      add(scene, "flat", {square(0)}, 0);
      add(scene, "upright", {Mesh{{{9, 0, 0}, {9, 1, 0}, {9, 1, 1}, {9, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}}}, 0);
      auto settings = settings_of(method);
      // four facets do not fill the lines that qualities count per organ and element
      settings.density.sky_directions = settings.density.directions = 1024;
      settings.density.sky_lines_per_organ = settings.density.lines_per_element = 200;
      const auto run = solve(scene, settings);
      CAPTURE(name_of(method), name_of(model), reflectance);
      for (const std::size_t f : {0, 1}) {
        CHECK(run.kept.on(f, 0) == Approx(100).epsilon(2e-3));
        CHECK(run.kept.on(f, 1) == Approx(model == SkyModel::sphere ? 100.0 : 0.0).margin(0.1));
      }
      if (model == SkyModel::clear) continue;
      const double upright = model == SkyModel::sphere    ? 100
                             : model == SkyModel::uniform ? 50
                                                          : 100 * 3.0 / 7.0 * (0.5 + 4.0 / (3.0 * std::numbers::pi));
      for (const std::size_t f : {2, 3})
        for (int side = 0; side < 2; ++side) CHECK(run.kept.on(f, side) == Approx(upright).epsilon(2e-3));
    }
}
