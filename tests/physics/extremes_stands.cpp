// Extremes of number, density and period.
#include <catch2/catch.hpp>

#include <algorithm>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Scene black_canopy(double leaf_area_index, double side, double width, double depth, double height) {
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {0}, {0})});
  scene.periodic = PeriodicCell{0, 0, width, depth};
  scene.ground = flat_ground({width, depth}, {0.5 * width, 0.5 * depth}, {2, 2}, {0});
  point_sun(scene, {0, 0, 1}, 1);
  const auto n = static_cast<int>(std::lround(leaf_area_index * width * depth / (side * side)));
  add(scene, "canopy", leaves(std::max(n, 1), side, {width, depth, height}, 4), 0);
  return scene;
}

double on_ground(const Run& run) {
  return run.report.balance[0][0].ground / run.report.balance[0][0].incident;
}

void check_whole(const Run& run, double area) {
  const auto& b = run.report.balance[0][0];
  CAPTURE(b.incident, b.leaves, b.ground);
  CHECK(b.incident == Approx(area).epsilon(2e-3));
  CHECK(std::abs(b.residual()) < 2e-3 * b.incident);
}

}  // namespace

TEST_CASE("extremes: leaf area index from .01 to 50", "[extremes]") {
  // Leaves of all angles stop a vertical beam with probability 1 - exp(-LAI / 2) in the mean; one canopy of n leaves in a cell of 25 leaf
  // areas scatters by less than .15 about it.
  for (const auto method : both_methods)
    for (const double index : {0.01, 1.0, 8.0, 50.0}) {
      const double width = index < 0.1 ? 10 : 1;
      const auto run = solve(black_canopy(index, index < 0.1 ? 1.0 : 0.2, width, width, 2), method, Quality::draft);
      CAPTURE(name_of(method), index);
      check_whole(run, width * width);
      CHECK(on_ground(run) == Approx(std::exp(-0.5 * index)).margin(0.15));
      if (index >= 50) CHECK(on_ground(run) < 1e-6);
    }
  // and with light that is scattered: all of it is found again
  for (const auto method : both_methods) {
    auto scene = black_canopy(50, 0.2, 1, 1, 2);
    scene.optics = {uniform_optics("leaf", {0.45}, {0.45})};
    const auto run = solve(scene, method, Quality::draft);
    CHECK(run.report.status == SolveStatus::converged);
    CHECK(run.report.convergence.size() <= 20);
    CHECK(std::abs(run.report.balance[0][0].residual()) < 0.01);
  }
}

TEST_CASE("extremes: a cell a thousand times wider than high, and the reverse", "[extremes]") {
  for (const auto method : both_methods) {
    CAPTURE(name_of(method));
    const auto wide = solve(black_canopy(1, 0.5, 40, 40, 0.04 + 1.0), method, Quality::draft);  // leaves stand out of a layer of 4 cm
    check_whole(wide, 1600);
    CHECK(on_ground(wide) == Approx(std::exp(-0.5)).margin(0.05));
    // 1000 leaves in a column of 0.1 m x 0.1 m and 100 m
    auto high = black_canopy(25, 0.0158, 0.1, 0.1, 100);
    const auto column = solve(high, method, Quality::draft);
    check_whole(column, 0.01);
    CHECK(on_ground(column) < 1e-4);
    // a low sun crosses 570 images of the cell before it leaves the column
    high.states[0].sun->direction = direction_from_angles(30, 10);
    high.states[0].sun->irradiance = {2};
    check_whole(solve(high, method, Quality::draft), 0.01);
  }
}

TEST_CASE("extremes: a plant that crosses the cell's border", "[extremes]") {
  // Moved by half a cell the scene is the same.
  const auto scene_at = [](double shift) {
    auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
    scene.periodic = PeriodicCell{0, 0, 1, 1};
    scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {0.1, 0.2});
    sky(scene, SkyModel::uniform, 100);
    point_sun(scene, {0.5, 0.1, 0.7}, 400);
    scene.plants.push_back(plant_entry("plant", make_plant(leaves(40, 0.2, {0.6, 0.6, 0.6}, 5), "plant"), 0,
                                       {placed({.position = {shift + 0.2, shift + 0.2, 0}})}));
    return scene;
  };
  for (const auto method : both_methods) {
    const auto inside = solve(scene_at(0), method), across = solve(scene_at(0.5), method), beyond = solve(scene_at(1000), method);
    CAPTURE(name_of(method));
    for (std::size_t band = 0; band < 2; ++band)
      for (const auto* other : {&across, &beyond}) {
        auto a = organ_power(inside, band), b = organ_power(*other, band);
        a.resize(40), b.resize(40);                             // leaves only: ground cells lie elsewhere
        CHECK(relative_rms(b, a) < (band == 0 ? 0.02 : 0.04));  // the same light on other lines: the accuracy of the quality
      }
  }
}

TEST_CASE("extremes: a hundred thousand structures side by side", "[extremes]") {
  // Tiles of a plane, one organ each: all have what the plane has.
  constexpr int n = 320;
  std::vector<Mesh> tiles;
  for (int i = 0; i < n * n; ++i) {
    const double x = i % n, y = i / n;
    tiles.push_back({{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  }
  auto scene = scene_with({"a"}, {uniform_optics("leaf", {0.4}, {0.4})});
  point_sun(scene, {0.6, 0, 0.8}, 100);
  add(scene, "plane", std::move(tiles), 0);
  auto settings = settings_of(RadiosityMethod::clustering, Quality::draft);
  settings.density.sun_lines_per_organ = 20;
  settings.density.directions = 8;
  const auto run = solve(scene, settings);
  CHECK(run.report.status == SolveStatus::converged);
  double worst = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f) worst = std::max(worst, std::abs(run.kept.on(f, 0) - 80) + run.kept.on(f, 1));
  CHECK(worst < 0.1);  // all lines that meet a facet are lit, however few they are
  // 5 leaves of a line each way
  CHECK(std::abs(run.report.balance[0][0].residual()) < 2e-3 * run.report.balance[0][0].incident);
}

TEST_CASE("extremes: a hierarchy ten thousand deep", "[extremes]") {
  // A chain of structures, each with a leaf, against the same leaves side by side.
  const auto meshes = leaves(10'000, 0.02, {1, 1, 1}, 12);
  Plant chain = empty_plant("chain");
  std::uint32_t parent = 0;
  for (const auto& mesh : meshes) {
    parent = add_structure(chain, parent, "metamer", "");
    add_mesh(chain, mesh, std::vector<std::uint32_t>(2, parent), std::vector<std::uint32_t>(2, chain.material_index("")));
  }
  auto deep = scene_with({"a"}, {uniform_optics("leaf", {0.45}, {0.45})});
  sky(deep, SkyModel::uniform, 100);
  point_sun(deep, {0.5, 0.1, 0.7}, 400);
  auto flat = deep;
  deep.plants.push_back(plant_entry("chain", chain, 0, {placed({})}));
  add(flat, "flat", meshes, 0);
  const auto a = solve(deep, RadiosityMethod::clustering, Quality::draft), b = solve(flat, RadiosityMethod::clustering, Quality::draft);
  CHECK(a.report.status == SolveStatus::converged);
  // the same leaves in another tree: other lines for elements, the accuracy of draft
  CHECK(relative_rms(organ_power(a), organ_power(b)) < 0.04);
}
