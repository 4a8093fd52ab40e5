// Canopies without end on inclined planes: closed forms, and level canopies that are turned with their sun.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/scene/slope.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

enum class By { direct, clustering, flat, instantiation, reference };
const char* name_of(By by) {
  constexpr const char* names[] = {"direct", "clustering", "flat", "instantiation", "reference"};
  return names[static_cast<int>(by)];
}

Run solve_by(Scene scene, By by, Quality quality = Quality::standard, std::uint32_t samples = 4096) {
  lay_on_slope(scene);
  for (auto& state : scene.states)
    if (state.sky) prepare_sky(*state.sky, "test");
  if (by == By::reference) return reference_runs::trace(scene, samples);
  if (by != By::instantiation)
    return solve(scene,
                 by == By::direct ? RadiosityMethod::direct
                 : by == By::flat ? RadiosityMethod::flat
                                  : RadiosityMethod::clustering,
                 quality);
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(quality);
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

/// Irradiance of the ground's front, area mean.
double on_ground(const Run& run) {
  double sum = 0, area = 0;
  for (std::size_t f = run.facets.plant_facets; f < run.facets.size(); ++f) {
    sum += run.facets.area[f] * run.kept.on(f, 0, 0);
    area += run.facets.area[f];
  }
  return sum / area;
}

/// A slope of an angle that falls towards an azimuth from north over east, with a speck of a leaf over it that shades nothing to speak of.
Scene slope(double angle_deg, double towards_deg, double reflectance = 0.0) {
  auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0.0}, {0.0})});
  const double fall = std::tan(angle_deg * degree);
  scene.periodic = PeriodicCell{0, 0, 2, 1, -fall * std::sin(towards_deg * degree), -fall * std::cos(towards_deg * degree)};
  scene.ground = flat_ground({2, 1}, {1, 0.5}, {2, 1}, {reflectance});
  Mesh speck = square(0, 0.05);
  for (auto& p : speck.vertices) p += Vec3{0.5, 0.5, 3.0};
  add(scene, "speck", {speck}, 0);
  return scene;
}

/// Absorbed by each organ of the plants: ground that leans is one organ, flat ground one a cell.
std::vector<double> leaf_power(const Run& run) {
  auto power = organ_power(run);
  power.resize(run.facets.organ[run.facets.plant_facets - 1] + std::size_t{1});
  return power;
}

constexpr By all[] = {By::direct, By::clustering, By::flat, By::instantiation, By::reference};

}  // namespace

TEST_CASE("a bare slope without end gets what its plane sees of the sky, and of the sun", "[slope]") {
  for (const double angle : {0.0, 30.0, 60.0})
    for (const double towards : {180.0, 70.0}) {
      const double s = angle * degree;
      const Vec3 normal{std::sin(s) * std::sin(towards * degree), std::sin(s) * std::cos(towards * degree), std::cos(s)};
      auto uniform = slope(angle, towards), overcast = uniform, sunny = uniform;
      sky(uniform, SkyModel::uniform, 100);
      sky(overcast, SkyModel::standard_overcast, 100);
      point_sun(sunny, direction_from_angles(50, 160), 100);
      const double seen = 50 * (1 + std::cos(s));
      const double dull = 100 * (pi / 6 * (1 + std::cos(s)) + 4.0 / 9.0 * (std::sin(s) + (pi - s) * std::cos(s))) / (7 * pi / 9);
      for (const By by : all) {
        CAPTURE(angle, towards, name_of(by));
        CHECK(on_ground(solve_by(uniform, by)) == Approx(seen).epsilon(0.005));
        CHECK(on_ground(solve_by(overcast, by)) == Approx(dull).epsilon(0.005));
        CHECK(on_ground(solve_by(sunny, by)) == Approx(100 * glm::dot(normal, sunny.states[0].sun->direction)).epsilon(0.002));
      }
    }
}

TEST_CASE("a white slope sends all light back to the sky, and none through itself", "[slope]") {
  auto scene = slope(40, 130, 1.0);
  sky(scene, SkyModel::uniform, 100);
  for (const By by : {By::clustering, By::reference}) {
    const auto run = solve_by(scene, by);
    CAPTURE(name_of(by));
    for (std::size_t f = run.facets.plant_facets; f < run.facets.size(); ++f) CHECK(run.kept.on(f, 1, 0) == Approx(0.0).margin(1e-3));
    CHECK(on_ground(run) == Approx(50 * (1 + std::cos(40 * degree))).epsilon(0.005));
  }
}

TEST_CASE("a sun behind the slope is none", "[slope]") {
  auto scene = slope(60, 180);
  point_sun(scene, direction_from_angles(50, 0), 100);  // 50 degrees high in the north, over a slope of 60 to the south
  const auto notes = lay_on_slope(scene);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0] == "sun: the sun stands behind the slope: no sun");
  CHECK_FALSE(scene.states[0].sun);
  CHECK(lay_on_slope(scene).empty());
}

TEST_CASE("leaves on a slope let through exp(-G a H cos S / (n . s))", "[slope]") {
  // Plants shifted in z alone: height 1.5 m, 2 m^2 m^-3 of leaves of spherical angles (G = 1/2), 30 degrees to the south.
  const double fall = std::tan(30 * degree), side = 0.03, height = 1.5;
  const Vec3 box{2, 2, height + 2 * side};
  const int n = static_cast<int>(2.0 * 2 * 2 * height / (side * side));
  const struct { double elevation, azimuth, transmitted; } suns[] = {{60, 180, 0.27279}, {60, 0, 0.07442}, {30, 180, 0.22313}};
  for (const auto& sun : suns) {
    double sum = 0;
    constexpr int canopies = 4;
    for (int k = 0; k < canopies; ++k) {
      auto scene = scene_with({"PAR"}, {uniform_optics("leaf", {0.0}, {0.0})});
      scene.periodic = PeriodicCell{0, 0, 2, 2, 0, fall};
      auto meshes = leaves(n, side, box, 11 + static_cast<std::uint64_t>(k));
      for (auto& mesh : meshes) {
        const Vec3 middle = 0.25 * (mesh.vertices[0] + mesh.vertices[1] + mesh.vertices[2] + mesh.vertices[3]);
        for (auto& p : mesh.vertices) p.z += scene.periodic->slope_y * middle.y;  // whole leaves: their angles stay spherical
      }
      add(scene, "canopy", std::move(meshes), 0);
      scene.ground = flat_ground({2, 2}, {1, 1}, {8, 8}, {0.0});
      point_sun(scene, direction_from_angles(sun.elevation, sun.azimuth), 100);
      const Vec3 normal = glm::normalize(Vec3{0, -scene.periodic->slope_y, 1});
      sum += on_ground(solve_by(scene, By::direct)) / (100 * glm::dot(normal, scene.states[0].sun->direction)) / canopies;
    }
    CAPTURE(sun.elevation, sun.azimuth);
    CHECK(sum == Approx(sun.transmitted).epsilon(0.05));  // one canopy of 13,000 leaves differs from the next by 3 %
  }
}

TEST_CASE("a canopy that is turned with its sun gets the same light: on a slope as on level ground", "[slope]") {
  for (const double angle : {25.0, -50.0}) {
    const double c = std::cos(angle * degree), s = std::sin(angle * degree);
    const auto turned = [&](const Vec3& p) { return Vec3{c * p.x - s * p.z, p.y, s * p.x + c * p.z}; };  // x rises
    auto level = scene_with({"NIR"}, {uniform_optics("leaf", {0.45}, {0.40})});
    level.periodic = PeriodicCell{0, 0, 1.5, 1};
    level.ground = flat_ground({1.5, 1}, {0.75, 0.5}, {3, 2}, {0.3});
    add(level, "canopy", leaves(120, 0.15, {1.5, 1, 0.8}, 5), 0);
    point_sun(level, {0.2, -0.4, 0.8}, 100);
    auto slanting = level;
    slanting.periodic = PeriodicCell{0, 0, 1.5 * c, 1, s / c, 0};
    slanting.ground = flat_ground({1.5 * c, 1}, {0.75 * c, 0.5}, {3, 2}, {0.3});
    auto meshes = leaves(120, 0.15, {1.5, 1, 0.8}, 5);
    for (auto& mesh : meshes)
      for (auto& p : mesh.vertices) p = turned(p);
    slanting.plants.clear();
    add(slanting, "canopy", std::move(meshes), 0);
    point_sun(slanting, turned(level.states[0].sun->direction), 100);
    for (const By by : all) {
      const auto a = solve_by(level, by), b = solve_by(slanting, by);
      CAPTURE(angle, name_of(by));
      CHECK(on_ground(b) == Approx(on_ground(a)).epsilon(by == By::instantiation ? 0.02 : 0.01));
      CHECK(relative_rms(leaf_power(b), leaf_power(a)) < (by == By::instantiation ? 0.03 : 0.02));
    }
  }
}

TEST_CASE("methods agree on a slope under an overcast sky, organ by organ", "[slope]") {
  auto scene = scene_with({"NIR"}, {uniform_optics("leaf", {0.45}, {0.40})});
  scene.periodic = PeriodicCell{-0.5, 0, 1, 1, 0.4, -0.7};
  auto meshes = leaves(120, 0.15, {1.5, 1, 0.8}, 7);
  for (auto& mesh : meshes)
    for (auto& p : mesh.vertices) p.x -= 0.5, p.z += 0.4 * p.x - 0.7 * p.y;
  add(scene, "canopy", std::move(meshes), 0);
  scene.ground = flat_ground({1.5, 1}, {0.25, 0.5}, {3, 2}, {0.3});
  sky(scene, SkyModel::standard_overcast, 100);
  const auto reference = solve_by(scene, By::reference, Quality::standard, 16384);
  for (const By by : {By::clustering, By::flat, By::instantiation}) {
    const auto run = solve_by(scene, by);
    CAPTURE(name_of(by));
    // one copy that is its own surroundings is what instantiation does worst: 3.3 and 2.6 %, as on level ground
    const bool copies = by == By::instantiation;
    CHECK(on_ground(run) == Approx(on_ground(reference)).epsilon(copies ? 0.04 : 0.02));
    CHECK(relative_rms(leaf_power(run), leaf_power(reference)) < (copies ? 0.035 : 0.02));
  }
  // Light that is not absorbed leaves: the cell gets E (integral of the seen sky) and its parts add up to it.
  CHECK(relative_rms(leaf_power(solve_by(scene, By::flat)), leaf_power(solve_by(scene, By::clustering))) < 0.02);
}

TEST_CASE("ground that leans by itself is the ground of a slope given as a mesh", "[slope]") {
  auto own = slope(35, 200, 0.4), given = own;
  sky(own, SkyModel::clear, 100);
  own.states[0].sky->sun = direction_from_angles(40, 150);
  given.states = own.states;
  lay_on_slope(own);
  Mesh plane;
  for (const auto& p : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 1, 0}, Vec3{0, 1, 0}})
    plane.vertices.push_back({p.x, p.y, given.periodic->slope_x * p.x + given.periodic->slope_y * p.y});
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  given.ground->mesh = plane;
  CHECK(on_ground(solve_by(given, By::clustering)) == Approx(on_ground(solve_by(own, By::clustering))).epsilon(0.002));
}
