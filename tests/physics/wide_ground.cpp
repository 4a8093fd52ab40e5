// Ground whose cells are much wider than what stands on it, and leaves wider than a periodic cell.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Run copies(const Scene& scene) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(Quality::standard);
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

}  // namespace

TEST_CASE("a plate casts its shadow on ground of any cells") {
  // Black plate of 1 m, 1 m above the ground, sun at the zenith: its lower side sees all of the ground but its own shadow, of which it
  // sees .1998 (two parallel squares, Howell C-11).
  const double expected = 0.5 * 100.0 * (1.0 - 0.1998);
  const auto check = [&](std::uint32_t cells, bool mesh, Vec3 at) {
    auto scene = scene_with({"PAR"}, {uniform_optics("plate", {0.0}, {0.0})});
    point_sun(scene, {0, 0, 1}, 100);
    scene.ground = flat_ground({1000, 1000}, {0, 0}, {cells, cells}, {0.5});
    if (mesh) scene.ground->mesh = Mesh{{{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    add(scene, "plate", {square(1)}, 0);
    Stance s;
    s.position = at;
    scene.plants[0].placements = {placed(s)};
    CAPTURE(cells, mesh, at.x);
    for (const auto& run : {solve(scene, RadiosityMethod::clustering), solve(scene, RadiosityMethod::flat), copies(scene)}) {
      CAPTURE(run.report.method);
      CHECK(0.5 * (run.kept.on(0, 1, 0) + run.kept.on(1, 1, 0)) == Approx(expected).epsilon(0.02));
      double ground = 0.0;
      for (std::size_t f = 2; f < run.facets.size(); ++f) ground += run.facets.area[f] * run.kept.on(f, 0, 0);
      CHECK(run.facets.size() == (mesh ? 4u : 2 + 2 * cells * cells));
      CHECK(ground == Approx(100.0 * (1e6 - 1.0)).epsilon(1e-5));
    }
  };
  check(10, false, {3, 4, 0});
  check(1, false, {3, 4, 0});
  check(10, false, {-431, 377, 0});
  check(1, true, {30, -40, 0});
}

TEST_CASE("leaves wider than their periodic cell are lit as by path tracing") {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.1, 0.4}, {0.05, 0.42})});
  scene.periodic = PeriodicCell{0, 0, 0.2, 0.15};
  scene.ground = flat_ground({0.2, 0.15}, {0.1, 0.075}, {2, 2}, {0.15, 0.3});
  point_sun(scene, {0.3, -0.4, 0.8}, 400);
  sky(scene, SkyModel::standard_overcast, 100);
  add(scene, "leaves", leaves(6, 0.3, {0.4, 0.4, 1.0}, 7), 0);
  const auto truth = reference_runs::trace(scene, 1024);
  for (const auto method : both_methods) {
    const auto run = solve(scene, method);
    for (std::size_t band = 0; band < 2; ++band) {
      double a = 0, b = 0;
      for (std::size_t f = 0; f < run.facets.plant_facets; ++f)
        a += run.facets.area[f] * run.absorbed(f, band), b += run.facets.area[f] * truth.absorbed(f, band);
      CAPTURE(name_of(method), band);
      CHECK(a == Approx(b).epsilon(band == 0 ? 0.01 : 0.02));
    }
  }
}

TEST_CASE("instantiation refuses suns that are too wide for it") {
  auto scene = scene_with({"PAR"}, {uniform_optics("plate", {0.0}, {0.0})});
  point_sun(scene, {0, 0, 1}, 100);
  scene.states[0].sun->angular_diameter_deg = 60;
  add(scene, "plate", {square(1)}, 0);
  try {
    copies(scene);
    FAIL("accepted");
  } catch (const InputError& e) {
    CHECK(std::string(e.what()) ==
          "scene in memory: sun.angular_diameter: found 60 with method 'instantiation'; expected at most 5 degrees, or method clustering, "
          "flat, direct or reference");
  }
}
