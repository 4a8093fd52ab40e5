// White furnaces: where nothing absorbs, every side sees the sky's radiance.
#include <catch2/catch.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

TEST_CASE("reference: white furnace under the sphere sky") {
  auto scene = scene_with({"a", "b"}, {{"leaf", {0.7f, 0.2f}, {0.4f, 0.5f}, {0.3f, 0.5f}}});
  scene.optics[0].reflectance_back = {0.7f, 0.5f};
  scene.optics[0].reflectance_front = {0.7f, 0.5f};
  sky(scene, SkyModel::sphere, 1);
  add(scene, "crown", leaves(60, 0.3, {1, 1, 1}, 3), 0);
  const auto run = trace(scene, 512);
  double worst = 0, mean = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f)
    for (int side = 0; side < 2; ++side)
      for (std::size_t b = 0; b < 2; ++b) {
        const double difference = run.kept.on(f, side, b) - 1;
        worst = std::max(worst, std::abs(difference));
        mean += difference / (4.0 * static_cast<double>(run.facets.size()));
      }
  // two bands of unlike reflectance share paths: their weights scatter a little about 1
  CHECK(worst < 0.08);
  CHECK(std::abs(mean) < 0.003);
  for (std::size_t b = 0; b < 2; ++b) {
    CHECK(std::abs(run.report.balance[0][b].leaves) < 1e-5);
    CHECK(std::abs(run.report.balance[0][b].residual()) < 0.01 * run.report.balance[0][b].incident);
  }
}

TEST_CASE("reference: one conservative band gives exactly 1 under the sphere sky") {
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {0.5}, {0.5})});
  sky(scene, SkyModel::sphere, 1);
  add(scene, "crown", leaves(40, 0.3, {1, 1, 1}, 3), 0);
  const auto run = trace(scene, 16);
  for (const float e : run.kept.irradiance) CHECK(e == Approx(1).epsilon(1e-6));
}

TEST_CASE("reference: conservative periodic canopy over white ground") {
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {0.5}, {0.5})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {1});
  sky(scene, SkyModel::uniform, 1);
  add(scene, "canopy", leaves(100, 0.15, {1, 1, 0.5}, 9), 0);
  const auto run = trace(scene, 32);
  for (std::size_t f = 0; f < run.facets.size(); ++f) {
    CHECK(run.kept.on(f, 0) == Approx(1).epsilon(2e-3));
    CHECK(run.kept.on(f, 1) == Approx(f < run.facets.plant_facets ? 1 : 0).epsilon(2e-3));  // below the ground it is dark
  }
  const auto& balance = run.report.balance[0][0];
  CHECK(balance.incident == Approx(1).epsilon(0.1));  // 3 % noise at 32 samples a facet
  CHECK(balance.escaped == Approx(balance.incident).epsilon(1e-6));
}
