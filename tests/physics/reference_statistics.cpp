// What the reference method says of its own errors, and of threads, states, periods and odd facets.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {
Scene small_canopy() {
  auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {0.12, 0.2});
  point_sun(scene, {0.3, 0.2, 0.8}, 400);
  scene.states[0].sun->angular_diameter_deg = 0.53;
  sky(scene, SkyModel::standard_overcast, 90);
  add(scene, "canopy", leaves(60, 0.2, {1, 1, 0.5}, 9), 0);
  return scene;
}
}  // namespace

TEST_CASE("reference: the same bits for any number of threads") {
  const auto scene = small_canopy();
  const auto one = trace(scene, 32, 7, 1), two = trace(scene, 32, 7, 2), other = trace(scene, 32, 8, 2);
  CHECK(one.kept.complete());
  CHECK(one.kept.irradiance == two.kept.irradiance);
  CHECK(one.kept.variance == two.kept.variance);
  CHECK(one.kept.sunlit == two.kept.sunlit);
  CHECK(one.report.balance[0][1].escaped == two.report.balance[0][1].escaped);
  CHECK(one.report.counts == two.report.counts);
  CHECK(one.kept.irradiance != other.kept.irradiance);
}

TEST_CASE("reference: stored variances are those that seeds show") {
  const auto scene = small_canopy();
  constexpr int runs = 30;
  std::vector<double> sum, square, stored;
  for (int r = 0; r < runs; ++r) {
    const auto run = trace(scene, 16, 100 + r);
    const std::size_t n = run.facets.size() * 2;
    sum.resize(n), square.resize(n), stored.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double a = run.absorbed(i / 2, i % 2);
      sum[i] += a, square[i] += a * a, stored[i] += run.kept.variance_of(i / 2, i % 2) / runs;
    }
  }
  double ratio = 0;
  int n = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double seen = (square[i] - sum[i] * sum[i] / runs) / (runs - 1);
    if (stored[i] <= 0) continue;
    ratio += seen / stored[i], ++n;
  }
  // about 250 ratios with 29 and 450 degrees of freedom: their mean scatters by .02
  CHECK(ratio / n == Approx(1).margin(0.1));
}

TEST_CASE("reference: balance closes within its noise, incident light is the cell's") {
  const auto scene = small_canopy();
  const auto run = trace(scene, 256);
  const double cos_zenith = scene.states[0].sun->direction.z;
  for (const auto& balance : run.report.balance[0]) {
    CHECK(balance.incident == Approx(400 * cos_zenith + 90).epsilon(0.01));
    CHECK(std::abs(balance.residual()) < 0.02 * balance.incident);
  }
}

TEST_CASE("reference: states share paths and give what separate runs give") {
  auto scene = small_canopy();
  scene.states.push_back(scene.states[0]);
  scene.states[1].sun->direction = glm::normalize(Vec3{-0.5, 0.1, 0.4});
  scene.states[1].sky->model = SkyModel::uniform;
  const auto both = trace(scene, 256);
  auto alone = small_canopy();
  alone.states[0] = scene.states[1];
  const auto second = trace(alone, 256, 99);
  double z2 = 0;
  int n = 0;
  for (std::size_t f = 0; f < both.facets.size(); ++f)
    for (std::size_t b = 0; b < 2; ++b) {
      const double variance = both.kept.variance_of(f, b, 1) + second.kept.variance_of(f, b);
      if (variance <= 0) continue;
      const double d = both.absorbed(f, b, 1) - second.absorbed(f, b);
      z2 += d * d / variance, ++n;
    }
  CHECK(z2 / n == Approx(1).margin(0.35));  // 256 values of which two bands share paths; z with 30 degrees of freedom
}

TEST_CASE("reference: a cell equals three by three of them") {
  auto scene = small_canopy();
  auto larger = scene;
  larger.periodic = PeriodicCell{0, 0, 3, 3};
  larger.ground = flat_ground({3, 3}, {1.5, 1.5}, {6, 6}, {0.12, 0.2});
  larger.plants[0].placements.clear();
  for (int i = 0; i < 9; ++i) larger.plants[0].placements.push_back(placed({.position = {double(i / 3), double(i % 3), 0}}));
  const auto one = trace(scene, 256), nine = trace(larger, 32);
  double z2 = 0;
  int count = 0;
  for (std::size_t f = 0; f < one.facets.plant_facets; ++f)
    for (std::size_t b = 0; b < 2; ++b) {
      double mean = 0, variance = one.kept.variance_of(f, b);
      for (std::size_t copy = 0; copy < 9; ++copy) {
        mean += nine.absorbed(copy * one.facets.plant_facets + f, b) / 9;
        variance += nine.kept.variance_of(copy * one.facets.plant_facets + f, b) / 81;
      }
      const double d = one.absorbed(f, b) - mean;
      if (variance > 0) z2 += d * d / variance, ++count;
    }
  CHECK(z2 / count == Approx(1).margin(0.35));
}

TEST_CASE("reference: facets without area are rows of zeros") {
  auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0.1}, {0.1})});
  sky(scene, SkyModel::uniform, 1);
  add(scene, "leaf", {Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}}, {{0, 1, 3}, {0, 1, 2}}}}, 0);
  const auto run = trace(scene, 64);
  CHECK(run.kept.on(0, 0) == 0.0);
  CHECK(run.kept.on(0, 1) == 0.0);
  CHECK(run.kept.on(1, 0) == Approx(1));
}

TEST_CASE("reference: the user can stop it") {
  class Impatient : public Progress {
   public:
    bool cancelled() const override { return true; }
  } impatient;
  const auto scene = small_canopy();
  const auto facets = expand(scene);
  Kept kept(1, facets.size(), 2);
  CHECK_THROWS_AS(trace_reference(scene, facets, {}, kept, impatient), Stopped);
}
