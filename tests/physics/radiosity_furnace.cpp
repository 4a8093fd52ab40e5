// Radiosity: white furnaces, and light that is neither lost nor made.
#include <catch2/catch.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

void check_furnace(const Scene& scene, RadiosityMethod method, Quality quality, double incident) {
  const auto run = solve(scene, method, quality);
  CHECK(run.report.status == SolveStatus::converged);
  double worst = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f)
    for (int side = 0; side < (f < run.facets.plant_facets ? 2 : 1); ++side)  // below the ground it is dark
      for (std::size_t b = 0; b < scene.band_count(); ++b) worst = std::max(worst, std::abs(run.kept.on(f, side, b) - 1));
  CAPTURE(name_of(method), static_cast<int>(quality), worst);
  CHECK(worst < 2e-3);
  for (const auto& b : run.report.balance[0]) {
    CAPTURE(b.incident, b.leaves, b.ground, b.escaped, b.scattered_scale);
    CHECK(std::abs(b.scattered_scale - 1) < 1e-5);  // all that is met is white: each line gives back what it takes
    CHECK(std::abs(b.residual()) < 1e-5 * b.incident);
    CHECK(std::abs(b.leaves) < 1e-5 * b.incident);
    CHECK(std::abs(b.escaped / b.incident - 1) < 1e-5);
    if (incident > 0) CHECK(b.incident == Approx(incident).epsilon(1e-5));
  }
}

/// Two conservative bands: reflectance unlike transmittance, alike.
std::vector<Optics> white() {
  return {{"leaf", {0.7f, 0.5f}, {0.7f, 0.5f}, {0.3f, 0.5f}}};
}

}  // namespace

TEST_CASE("radiosity: white furnace over white ground in a periodic cell") {
  auto scene = scene_with({"a", "b"}, white());
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {1, 1});
  sky(scene, SkyModel::uniform, 1);
  add(scene, "canopy", leaves(150, 0.15, {1, 1, 0.6}, 9), 0);
  for (const auto method : both_methods)
    for (const auto quality : {Quality::draft, Quality::standard}) check_furnace(scene, method, quality, 1);
}

TEST_CASE("radiosity: white furnace under the sphere sky") {
  auto scene = scene_with({"a", "b"}, white());
  sky(scene, SkyModel::sphere, 1);
  add(scene, "crown", leaves(150, 0.2, {1, 1, 1}, 3), 0);
  for (const auto method : both_methods)
    for (const auto quality : {Quality::draft, Quality::standard}) check_furnace(scene, method, quality, 0);
}

TEST_CASE("radiosity: what conservative leaves over white soil reflect is what came in, under any light") {
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {0.5}, {0.5})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {1});
  add(scene, "canopy", leaves(150, 0.15, {1, 1, 0.6}, 9), 0);
  scene.states.resize(2);
  sky(scene, SkyModel::standard_overcast, 1);
  scene.states[1].sun = Sun{glm::normalize(Vec3{0.5, 0.3, 0.6}), {1 / glm::normalize(Vec3{0.5, 0.3, 0.6}).z}, 0.53};
  for (const auto method : both_methods)
    for (const auto quality : {Quality::draft, Quality::standard}) {
      const auto run = solve(scene, method, quality);
      for (std::size_t s = 0; s < 2; ++s) {
        const auto& b = run.report.balance[s][0];
        CAPTURE(name_of(method), static_cast<int>(quality), s, b.incident, b.leaves, b.escaped);
        CHECK(b.incident == Approx(1).epsilon(s == 0 ? 2e-4 : 1e-3));  // the sun's cells, full ones cannot take more than all
        CHECK(b.leaves == 0.0);
        // the sky and its reflections are counted on the same lines; the sun's cells see 1e-3 of its light wrongly, lines as much again
        CHECK(std::abs(b.scattered_scale - 1) < (s == 0 ? 4e-4 : 4e-3));
        // scattered light is scaled so that all of it escapes; rounding is left
        CHECK(b.escaped == Approx(b.incident).epsilon(1e-5));
        CHECK(std::abs(b.residual()) < 1e-5);
      }
    }
}

TEST_CASE("radiosity: light that black ground or grey leaves absorb adds up") {
  for (const bool periodic : {false, true}) {
    auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
    if (periodic) {
      scene.periodic = PeriodicCell{0, 0, 1, 1};
      scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {0, 0.2});
    } else {
      scene.ground = flat_ground({4, 4}, {0.5, 0.5}, {8, 8}, {0, 0.2});
    }
    sky(scene, SkyModel::uniform, 100);
    point_sun(scene, {0.5, 0.3, 0.6}, 400);
    add(scene, "canopy", leaves(150, 0.15, {1, 1, 0.6}, 9), 0);
    const double on_horizontal = 100 + 400 * scene.states[0].sun->direction.z;
    for (const auto method : both_methods) {
      const auto run = solve(scene, method);
      for (std::size_t band = 0; band < 2; ++band) {
        const auto& b = run.report.balance[0][band];
        CAPTURE(name_of(method), periodic, band, b.incident, b.leaves, b.ground, b.escaped, b.residual());
        if (periodic) {
          CHECK(b.incident == Approx(on_horizontal).epsilon(1e-4));
        }
        CHECK(std::abs(b.residual()) < 1e-5 * b.incident);
        CHECK(std::abs(b.scattered_scale - 1) < 3e-3);  // not by scaling
        double leaves_power = 0;
        for (std::size_t f = 0; f < run.facets.plant_facets; ++f) leaves_power += run.facets.area[f] * run.absorbed(f, band);
        CHECK(leaves_power == Approx(b.leaves).epsilon(1e-5));
      }
    }
  }
}

TEST_CASE("radiosity: what sampling misses of the scattered light falls with the number of lines") {
  // Residuals are rounding at any quality, since the scattered light is scaled; this is what the scaling hides.
  auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
  scene.ground = flat_ground({4, 4}, {0.5, 0.5}, {8, 8}, {0.1, 0.2});
  sky(scene, SkyModel::standard_overcast, 100);
  point_sun(scene, {0.5, 0.3, 0.6}, 400);
  add(scene, "canopy", leaves(150, 0.15, {1, 1, 0.6}, 9), 0);
  for (const auto method : both_methods) {
    double missed[2] = {0, 0};
    for (const auto quality : {Quality::draft, Quality::fine})
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto run = solve(scene, method, quality, seed);
        for (const auto& b : run.report.balance[0]) missed[quality == Quality::fine] += std::abs(b.scattered_scale - 1) / 12;
      }
    CAPTURE(name_of(method), missed[0], missed[1]);
    CHECK(missed[0] < 2e-3);
    CHECK(missed[1] < 0.5 * missed[0]);
  }
}

TEST_CASE("radiosity: a leaf low over sunlit soil") {
  // The gap is narrow, but not the inside of anything: the sun's light on the soil below must reach the leaf.
  auto scene = scene_with({"NIR"}, {uniform_optics("leaf", {0.45}, {0.45})});
  scene.periodic = PeriodicCell{0, 0, 0.3, 0.3};
  scene.ground = flat_ground({0.3, 0.3}, {0.15, 0.15}, {12, 12}, {0.3});
  point_sun(scene, {0.8, 0.1, 0.6}, 1000);
  add(scene, "leaf", {Mesh{{{0.1, 0.1, 0.02}, {0.2, 0.1, 0.02}, {0.2, 0.2, 0.02}, {0.1, 0.2, 0.02}}, {{0, 1, 2}, {0, 2, 3}}}}, 0);
  const auto reference = reference_runs::trace(scene, 4096);
  for (const auto method : both_methods) {
    const auto run = solve(scene, method, Quality::fine);
    const auto below = [](const Run& r) { return 0.5 * (r.kept.on(0, 1) + r.kept.on(1, 1)); };
    CAPTURE(name_of(method), below(run), below(reference));
    CHECK(below(run) == Approx(below(reference)).epsilon(0.03));  // soil cells are half in shade, and as large as the gap
    const double absorbed = run.absorbed(0) + run.absorbed(1), expected = reference.absorbed(0) + reference.absorbed(1);
    CHECK(absorbed == Approx(expected).epsilon(0.01));
  }
}
