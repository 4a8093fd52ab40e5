// Extremes of size, place and shape, each with a closed form or an invariance.
#include <catch2/catch.hpp>

#include <numbers>

#include <sunfleck/core/error.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

constexpr double exact = 2e-4;  // a plane's lines: single precision, and grids that are rounded to whole lines

std::vector<Optics> grey() {
  return {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}};
}

Scene crown(const Placement& placement, std::vector<Mesh> meshes = leaves(60, 0.25, {1, 1, 1}, 21)) {
  auto scene = scene_with({"PAR", "NIR"}, grey());
  sky(scene, SkyModel::standard_overcast, 100);
  point_sun(scene, {0.5, 0.1, 0.7}, 400);
  scene.plants.push_back(plant_entry("crown", make_plant(std::move(meshes), "crown"), 0, {placement}));
  return scene;
}

Scene black(std::vector<Mesh> meshes, const Vec3& sun = {0, 0, 1}) {
  auto scene = scene_with({"a"}, {uniform_optics("black", {0}, {0})});
  point_sun(scene, sun, 100);
  add(scene, "plant", std::move(meshes), 0);
  return scene;
}

/// Every value finite, and the light that comes in accounted for.
void check_sound(const Run& run, double most_residual = 5e-3) {
  CHECK(run.kept.complete());
  std::size_t broken = 0;
  for (const float e : run.kept.irradiance) broken += !(e >= 0 && std::isfinite(e));
  CHECK(broken == 0);
  for (const auto& state : run.report.balance)
    for (const auto& b : state) {
      CAPTURE(b.incident, b.leaves, b.ground, b.escaped);
      CHECK(std::abs(b.residual()) <= most_residual * b.incident);
    }
}

}  // namespace

TEST_CASE("extremes: scales of a millionth and a million", "[extremes]") {
  for (const auto method : both_methods) {
    const auto as_is = solve(crown(placed({})), method, Quality::draft);
    for (const double scale : {1e-6, 1e6}) {
      const auto run = solve(crown(placed({.scale = scale})), method, Quality::draft);
      CAPTURE(name_of(method), scale);
      check_sound(run);
      for (std::size_t band = 0; band < 2; ++band) {
        auto p = organ_power(run, band);
        for (auto& x : p) x /= scale * scale;
        CHECK(relative_rms(p, organ_power(as_is, band)) < 2e-3);  // rounding moves a few lines across edges
      }
    }
  }
}

TEST_CASE("extremes: leaves of a millimetre ten thousand kilometres away", "[extremes]") {
  for (const auto method : both_methods) {
    const auto near = solve(crown(placed({.scale = 0.004})), method, Quality::draft);
    const auto far = solve(crown(placed({.position = {1e7, -1e7, 10}, .scale = 0.004})), method, Quality::draft);
    CAPTURE(name_of(method));
    check_sound(far);
    // a double resolves 2e-9 m there, 2e-6 of a leaf: some lines cross edges, and some medians by which elements are cut fall otherwise
    for (std::size_t band = 0; band < 2; ++band) CHECK(relative_rms(organ_power(far, band), organ_power(near, band)) < 0.02);
  }
  // Embree's rays are single precision: the reference must move the scene to its own origin first
  const auto near = reference_runs::trace(crown(placed({.scale = 0.004})), 256),
             far = reference_runs::trace(crown(placed({.position = {1e7, -1e7, 10}, .scale = 0.004})), 256);
  CHECK(relative_rms(organ_power(far), organ_power(near)) < 0.03);  // two estimates of 256 samples a facet
}

TEST_CASE("extremes: slivers a million times as long as wide", "[extremes]") {
  // A square in slices of 1e-6 of its width and the rest: as the whole.
  Mesh cut;
  constexpr int slivers = 5;
  for (int i = 0; i <= slivers; ++i) {
    const double x = 1e-6 * i;
    cut.vertices.insert(cut.vertices.end(), {{x, 0, 0}, {x, 1, 0}});
  }
  cut.vertices.insert(cut.vertices.end(), {{1, 0, 0}, {1, 1, 0}});
  for (std::uint32_t i = 0; i <= slivers; ++i) {
    cut.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    cut.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  for (const auto method : both_methods) {
    const auto run = solve(black({cut}, {0.6, 0, 0.8}), method, Quality::draft);
    CAPTURE(name_of(method));
    check_sound(run);
    double power = 0;
    for (std::size_t f = 0; f < run.facets.size(); ++f) {
      CAPTURE(f);
      CHECK(run.kept.on(f, 0) == Approx(80).epsilon(5e-3));  // no line need meet a sliver: its organ's lines speak for it
      CHECK(run.kept.on(f, 1) == 0.0);
      power += run.facets.area[f] * run.absorbed(f);
    }
    CHECK(power == Approx(80).epsilon(5e-3));
  }
}

TEST_CASE("extremes: facets smaller than any sampling", "[extremes]") {
  // A triangle of a micrometre beside a leaf of a metre, and one above it.
  const auto speck = [](double x, double z) { return Mesh{{{x, 0.5, z}, {x + 1e-6, 0.5, z}, {x, 0.5 + 1e-6, z}}, {{0, 1, 2}}}; };
  for (const auto method : both_methods) {
    const auto run = solve(black({square(0), speck(5, 0), speck(0.5, 0.3)}), method, Quality::draft);
    CAPTURE(name_of(method));
    check_sound(run);
    CHECK(run.kept.on(0, 0) == Approx(100).epsilon(5e-3));
    // no line meets them: they have the mean of what they share an element with, or nothing, but never more than the sun
    for (const std::size_t f : {2, 3}) CHECK(run.kept.on(f, 0) <= 100.5);
  }
}

TEST_CASE("extremes: facets that cross, and a leaf that touches a stem", "[extremes]") {
  const Mesh level = square(0.5), upright{{{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  for (const auto method : both_methods) {
    CAPTURE(name_of(method));
    auto scene = black({level, upright}, {0.6, 0, 0.8});
    scene.optics = {uniform_optics("leaf", {0.4}, {0.4})};
    const auto run = solve(scene, method);
    check_sound(run);
    const auto reference = reference_runs::trace(scene, 2048);
    // one value a facet or element, where the light changes across the line of contact: a few per cent
    CHECK(relative_rms(organ_power(run), organ_power(reference)) < 0.04);
    // a leaf with its edge on a wall, and one that ends a millionth before it
    const auto leaf_from = [](double x) {
      return Mesh{{{x, 0, 0.5}, {x + 1, 0, 0.5}, {x + 1, 1, 0.5}, {x, 1, 0.5}}, {{0, 1, 2}, {0, 2, 3}}};
    };
    auto touching = scene, apart = scene;
    touching.plants.clear(), apart.plants.clear();
    add(touching, "plant", {leaf_from(0.5), upright}, 0);
    add(apart, "plant", {leaf_from(0.5 + 1e-6), upright}, 0);
    const auto a = solve(touching, method), b = solve(apart, method);
    check_sound(a);
    CHECK(relative_rms(organ_power(a), organ_power(b)) < 0.01);  // grids shift with the bounds: sampling
  }
}

TEST_CASE("extremes: a facet larger than the scene", "[extremes]") {
  for (const auto method : both_methods) {
    CAPTURE(name_of(method));
    const Mesh roof{{{-500, -500, 1}, {500, -500, 1}, {500, 500, 1}, {-500, 500, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto run = solve(black({square(0, 0.01), roof}, {0.1, 0, 1}), method, Quality::draft);
    check_sound(run);
    for (const std::size_t f : {0, 1}) CHECK(run.kept.on(f, 0) == 0.0);
    for (const std::size_t f : {2, 3}) CHECK(run.kept.on(f, 0) == Approx(100 / std::sqrt(1.01)).epsilon(5e-3));
  }
}

TEST_CASE("extremes: one facet, and none", "[extremes]") {
  const Mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const auto method : both_methods) {
    CAPTURE(name_of(method));
    const auto run = solve(black({one}, {0, 0.6, 0.8}), method);
    check_sound(run);
    CHECK(run.kept.on(0, 0) == Approx(80).epsilon(2e-3));
    CHECK(run.kept.on(0, 1) == 0.0);
  }
  auto scene = black({one});
  scene.plants.clear();
  CHECK_THROWS_AS(solve(scene, RadiosityMethod::flat), InputError);
  const auto no_area = black({Mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}});
  for (const auto method : both_methods)
    CHECK_THROWS_WITH(solve(no_area, method), Catch::Contains("found no facet with an area; expected at least one that light can meet"));
}

TEST_CASE("extremes: plants without area over ground", "[extremes]") {
  // A line throws no shadow: the ground has all of sun and sky, and gives a tenth back.
  auto scene = black({Mesh{{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, {{0, 1, 2}}}});
  sky(scene, SkyModel::uniform, 50);
  scene.ground = flat_ground({2, 2}, {0, 0}, {4, 4}, {0.1});
  for (const auto method : {RadiosityMethod::clustering, RadiosityMethod::flat, RadiosityMethod::direct}) {
    const auto run = solve(scene, method);
    check_sound(run);
    CHECK(run.report.balance[0][0].ground == Approx(0.9 * 4 * 150).epsilon(5e-3));  // lines at the border of the ground
    CHECK(run.report.balance[0][0].leaves == 0);
    CHECK(run.kept.on(0, 0) == 0);
  }
}

TEST_CASE("extremes: a sun at the zenith and one that grazes", "[extremes]") {
  for (const auto method : both_methods)
    for (const double elevation : {90.0, 10.0, 1.0, 0.1}) {
      const double sine = std::sin(elevation * std::numbers::pi / 180);
      const auto direction = direction_from_angles(elevation, 33);
      CAPTURE(name_of(method), elevation);
      const auto leaf = solve(black({square(0)}, direction), method);
      CHECK(leaf.kept.on(0, 0) == Approx(100 * sine).epsilon(5e-3));
      CHECK(leaf.kept.on(0, 1) == 0.0);
      // an endless canopy over soil takes all there is
      auto canopy = black(leaves(100, 0.15, {1, 1, 0.6}, 9), direction);
      canopy.periodic = PeriodicCell{0, 0, 1, 1};
      canopy.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {0});
      const auto run = solve(canopy, method);
      check_sound(run, 0.01);
      const auto& b = run.report.balance[0][0];
      CHECK(b.leaves + b.ground == Approx(100 * sine).epsilon(0.01));
    }
}

TEST_CASE("extremes: a plant below the ground", "[extremes]") {
  for (const auto method : both_methods) {
    auto scene = black({square(-1), square(1)});
    scene.ground = flat_ground({3, 3}, {0.5, 0.5}, {6, 6}, {0.5});
    sky(scene, SkyModel::uniform, 100);
    const auto run = solve(scene, method);
    CAPTURE(name_of(method));
    check_sound(run);
    // sky comes in between the ground's edge, about 1.5 m away and 1 m higher, and the horizon: sin^2 (33.7 degrees) = .31 of all for a
    // disc
    const auto reference = reference_runs::trace(scene, 2048);
    for (const std::size_t f : {0, 1}) {
      CHECK(run.kept.on(f, 0) == Approx(reference.kept.on(f, 0)).epsilon(0.05));
      CHECK(run.kept.on(f, 0) < 31);
    }
    for (const std::size_t f : {2, 3}) CHECK(run.kept.on(f, 0) == Approx(200).epsilon(5e-3));
  }
}

TEST_CASE("extremes: a mirrored copy under a mirrored sun", "[extremes]") {
  auto scene = crown(placed({})), mirrored = crown(placed({.mirror = true}));
  auto& sun = mirrored.states[0].sun->direction;
  sun.x = -sun.x;
  for (const auto method : both_methods) {
    const auto a = solve(scene, method), b = solve(mirrored, method);
    CAPTURE(name_of(method));
    // the same light on other lines: the accuracy of the quality
    CHECK(relative_rms(organ_power(a), organ_power(b)) < 0.02);
    CHECK(relative_rms(organ_power(a, 1), organ_power(b, 1)) < 0.04);
  }
}

TEST_CASE("extremes: a copy exactly on another", "[extremes]") {
  // Two copies of a plane: the stack of two with a vanishing gap, whichever lies above.
  constexpr double rho = 0.3, tau = 0.4;
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {rho}, {tau})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {0});
  sky(scene, SkyModel::uniform, 1);
  scene.plants.push_back(plant_entry("plane", make_plant({square(0.3)}, "plane"), 0, {placed({}), placed({})}));
  // from above: R = rho + tau^2 rho / (1 - rho^2), T = tau^2 / (1 - rho^2)
  const double reflected = rho + tau * tau * rho / (1 - rho * rho), transmitted = tau * tau / (1 - rho * rho);
  for (const auto method : both_methods) {
    const auto run = solve(scene, method);
    CAPTURE(name_of(method));
    check_sound(run);
    const auto& b = run.report.balance[0][0];
    CHECK(b.escaped == Approx(reflected).epsilon(exact));
    CHECK(b.ground == Approx(transmitted).epsilon(exact));
    CHECK(b.leaves == Approx(1 - reflected - transmitted).epsilon(exact));
  }
}
