// The path tracer against closed forms. Tolerances are five standard errors from the stored variance, unless the result has none.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {
void check_absorbed(const Run& run, std::size_t facet, double expected) {
  CAPTURE(facet, expected, run.absorbed(facet), run.standard_error(facet));
  CHECK(std::abs(run.absorbed(facet) - expected) <= 5.0 * run.standard_error(facet) + 1e-6 * expected);  // 1e-6: optics are floats
  CHECK(run.standard_error(facet) < 0.02 * expected);
}
}  // namespace

TEST_CASE("reference: two leaves exactly on each other") {
  auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0.06}, {0.04})});
  point_sun(scene, {0, 0, 1}, 100);
  add(scene, "leaves", {square(0), square(0)}, 0);  // the second is the upper one: higher rows lie above
  const auto run = trace(scene, 4096);
  for (const std::size_t f : {0, 1}) {
    CHECK(run.kept.on(f, 0) == Approx(4.01445).epsilon(0.002));
    check_absorbed(run, f, 0.9 * 100 * 0.04 / (1 - 0.06 * 0.06));
    CHECK(run.kept.on(f, 1) == 0.0);
  }
  CHECK(run.kept.on(2, 0) == Approx(100));
}

TEST_CASE("reference: a leaf plane over soil in a periodic cell") {
  auto scene = scene_with({"red"}, {uniform_optics("leaf", {0.3912}, {0.4146})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {1, 1}, {0.2142});
  sky(scene, SkyModel::uniform, 1);
  add(scene, "plane", {square(0.2)}, 0);
  const auto run = trace(scene, 16384);
  for (const std::size_t f : {0, 1}) check_absorbed(run, f, 0.21302372);
  for (const std::size_t f : {2, 3}) check_absorbed(run, f, (1 - 0.2142) * 0.45251883);
  const auto& balance = run.report.balance[0][0];
  CHECK(balance.incident == Approx(1).epsilon(1e-6));
  CHECK(balance.escaped == Approx(0.43138698).epsilon(0.03));  // 16 x 1024 particles: .4 % standard error, and 5 of them
  CHECK(std::abs(balance.residual()) < 0.03);
}

TEST_CASE("reference: three leaf planes over soil") {
  auto scene = scene_with({"red"}, {uniform_optics("leaf", {0.3912}, {0.4146})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {1, 1}, {0.2142});
  point_sun(scene, {0.4, 0.2, 1}, std::sqrt(1.2));  // 1 on the horizontal
  add(scene, "planes", {square(0.6), square(0.4), square(0.2)}, 0);
  const auto run = trace(scene, 16384);
  const double absorbed[] = {0.24183181, 0.12048213, 0.05424612};
  for (std::size_t f = 0; f < 6; ++f) check_absorbed(run, f, absorbed[f / 2]);
  for (const std::size_t f : {6, 7}) check_absorbed(run, f, (1 - 0.2142) * 0.11523314);
}

TEST_CASE("reference: a closed cavity that emits everywhere") {
  // Walls under the sphere sky let through .3 of the 1 W m^-2 that comes from everywhere: B = emitted / (1 - rho) inside.
  auto scene = scene_with({"PAR"}, {{"wall", {0.2f}, {0.5f}, {0.3f}}});
  sky(scene, SkyModel::sphere, 1);
  const Vec3 p[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const auto face = [&](int a, int b, int c, int d) { return Mesh{{p[a], p[b], p[c], p[d]}, {{0, 1, 2}, {0, 2, 3}}}; };
  add(scene, "walls", {face(0, 3, 2, 1), face(4, 5, 6, 7), face(0, 1, 5, 4), face(1, 2, 6, 5), face(2, 3, 7, 6), face(3, 0, 4, 7)},
      0);  // fronts outside
  const auto run = trace(scene, 4096);
  for (std::size_t f = 0; f < 12; ++f) {
    CHECK(run.kept.on(f, 0) == Approx(1).epsilon(1e-6));
    check_absorbed(run, f, 0.5 * 1 + 0.2 * 0.3 / (1 - 0.5));
  }
}

TEST_CASE("reference: Beer-Lambert through small black leaves of all angles") {
  auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0}, {0})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {8, 8}, {0});
  const double height = 0.5, side = 0.01, leaf_area_index = 2;
  add(scene, "canopy", leaves(static_cast<int>(leaf_area_index / (side * side)), side, {1, 1, height}, 5), 0);
  const FacetScene facets = expand(scene);
  for (const double zenith : {0.0, 60.0}) {
    point_sun(scene, {std::sin(zenith * std::numbers::pi / 180), 0, std::cos(zenith * std::numbers::pi / 180)}, 1);
    const RayScene rays(facets);
    const PathSampler sampler(scene, rays, 1);
    std::vector<CopyFacet> ground;
    for (std::size_t f = facets.plant_facets; f < facets.size(); ++f) ground.push_back(rays.at(f));
    SampleMeans means;
    sampler.sample(SampleTarget(rays, ground, 0), 0, 8192, 1, means);
    // one canopy of 20,000 leaves scatters by about .005 about the mean of all canopies, finite leaves add about as much
    CHECK(means.sunlit[0] == Approx(std::exp(-leaf_area_index / (2 * std::cos(zenith * std::numbers::pi / 180)))).margin(0.02));
  }
}

TEST_CASE("reference: a vertical plate under the overcast sky") {
  auto scene = scene_with({"PAR"}, {uniform_optics("plate", {0}, {0})});
  sky(scene, SkyModel::standard_overcast, 100);
  add(scene, "plate", {Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}}}, 0);
  const auto run = trace(scene, 4096);
  CHECK(std::abs(run.absorbed(0) - 2 * 100 * 3.0 / 7.0 * (0.5 + 4.0 / (3.0 * std::numbers::pi))) < 5 * run.standard_error(0) + 1e-3);
}
