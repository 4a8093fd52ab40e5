// What lies on the ground, by every method and the certificate, against closed forms.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

constexpr double sun_irradiance = 100.0, reflectance = 0.3, transmittance = 0.4, soil = 0.5;

enum class Way { clustering, flat, instantiation, reference };
constexpr Way ways[] = {Way::clustering, Way::flat, Way::instantiation, Way::reference};

Run run_of(const Scene& scene, Way way) {
  if (way == Way::clustering) return solve(scene, RadiosityMethod::clustering);
  if (way == Way::flat) return solve(scene, RadiosityMethod::flat);
  if (way == Way::reference) return reference_runs::trace(scene, 128);
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(Quality::standard);
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

/// A plate on the ground that receives E from above: below it, light goes to and fro between the two,
///     E_low = soil tau E / (1 - rho soil),  absorbed = (1 - rho - tau) (E + E_low).
double below(double above) {
  return soil * transmittance * above / (1.0 - reflectance * soil);
}
double absorbed(double above) {
  return (1.0 - reflectance - transmittance) * (above + below(above));
}

/// A square of 1 m over the origin, in its corner or its middle.
Mesh plate(double z, bool front_up) {
  auto mesh = square(z);
  if (!front_up)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Scene lying(bool front_up, double z = 0.0) {
  auto scene = scene_with({"PAR"}, {uniform_optics("film", {reflectance}, {transmittance})});
  point_sun(scene, {0, 0, 1}, sun_irradiance);
  scene.ground = flat_ground({4, 4}, {0.4, 0.45}, {4, 4}, {soil});
  add(scene, "film", {plate(z, front_up)}, 0);
  return scene;
}

Mesh moved(Mesh mesh, const Affine& map) {
  for (auto& p : mesh.vertices) p = map.point(p);
  return mesh;
}

void check_plates(const Scene& scene, Way way, double above, double margin = 0.01) {
  const auto run = run_of(scene, way);
  CAPTURE(static_cast<int>(way));
  double sum = 0.0, area = 0.0, incident = 0.0;
  for (std::size_t f = 0; f < run.facets.plant_facets; ++f) {
    sum += run.facets.area[f] * run.absorbed(f), area += run.facets.area[f];
    incident += run.facets.area[f] * (run.kept.on(f, 0, 0) + run.kept.on(f, 1, 0));
  }
  CHECK(sum / area == Approx(absorbed(above)).epsilon(margin));
  CHECK(incident / area == Approx(above + below(above)).epsilon(margin));
}

}  // namespace

TEST_CASE("a plate on the ground is lit from above and sees the ground below, whichever side is up") {
  for (const bool front_up : {true, false})
    for (const Way way : ways) {
      CAPTURE(front_up);
      check_plates(lying(front_up), way, sun_irradiance);
    }
}

TEST_CASE("what lies within rounding of the ground lies on it") {
  for (const double z : {-1e-9, -1e-6, 1e-9})
    for (const Way way : ways) {
      CAPTURE(z);
      check_plates(lying(true, z), way, sun_irradiance);
    }
}

TEST_CASE("plates on the ground far from the origin") {
  for (const Way way : ways) {
    auto scene = lying(false);
    const Vec3 far{1e6, -1e6, 1e3};
    scene.ground->centre = {far.x + 0.4, far.y + 0.45};
    scene.ground->height = far.z;
    scene.plants[0].placements = {placed({far})};
    check_plates(scene, way, sun_irradiance);
  }
}

TEST_CASE("copies on the ground") {
  auto scene = lying(true);
  scene.ground->size = {16, 16};
  scene.ground->cells = {8, 8};
  std::vector<Placement> places;
  for (int i = 0; i < 9; ++i) {
    Stance s;
    s.position = {3.5 * (i % 3) - 3.0, 3.5 * (i / 3) - 3.0, 0.0};
    s.turn_deg = 37.0 * i;
    s.scale = 1.0 + 0.05 * (i % 2);
    s.mirror = i % 3 == 1;
    places.push_back(placed(s));
  }
  scene.plants[0].placements = places;
  for (const Way way : ways) check_plates(scene, way, sun_irradiance);
}

TEST_CASE("a film on the ground of a periodic cell") {
  for (const Way way : ways) {
    auto scene = lying(true);
    scene.periodic = PeriodicCell{0, 0, 2, 2};
    scene.ground = flat_ground({2, 2}, {1, 1}, {2, 2}, {soil});
    check_plates(scene, way, sun_irradiance);
  }
}

TEST_CASE("a film on a slope of mesh ground, its corners at those of the ground") {
  const Affine tilt = placed({{0, 0, 0}, 0, 1, 25, 70, false}).map;
  for (const bool front_up : {true, false})
    for (const Way way : ways) {
      auto scene = lying(front_up);
      Mesh mesh;
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) mesh.vertices.push_back(tilt.point({i - 2.0, j - 2.0, 0.0}));
      for (std::uint32_t j = 0; j < 4; ++j)
        for (std::uint32_t i = 0; i < 4; ++i) {
          const std::uint32_t a = 5 * j + i;
          mesh.triangles.push_back({a, a + 1, a + 6});
          mesh.triangles.push_back({a, a + 6, a + 5});
        }
      scene.ground->mesh = mesh;
      scene.plants.clear();
      add(scene, "film", {moved(plate(0, front_up), tilt)}, 0);
      const double above = sun_irradiance * std::cos(25.0 * std::numbers::pi / 180.0);
      check_plates(scene, way, above, 0.015);
    }
}

TEST_CASE("half a millimetre over a kilometre of ground is above it, whatever the size of its cells") {
  for (const bool mesh : {false, true})
    for (const std::uint32_t cells : {1u, 10u})
      for (const Way way : ways) {
        CAPTURE(cells, mesh);
        auto scene = lying(false, 5e-4);
        scene.ground = flat_ground({1000, 1000}, {0, 0}, {cells, cells}, {soil});
        if (mesh) scene.ground->mesh = Mesh{{{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}}, {{0, 1, 2}, {0, 2, 3}}};
        // less than a thousandth of its lower side's light comes through the gap
        check_plates(scene, way, sun_irradiance, 0.015);
      }
}

TEST_CASE("a film darkens the soil, not what stands above it") {
  auto scene = scene_with({"PAR"}, {uniform_optics("film", {0.05}, {0.0}), uniform_optics("leaf", {0.0}, {0.0})});
  point_sun(scene, {0, 0, 1}, sun_irradiance);
  scene.ground = flat_ground({4, 4}, {0, 0}, {4, 4}, {soil});
  add(scene, "film", {moved(square(0, 4), Affine::translate({-2, -2, 0}))}, 0);
  add(scene, "leaf", {moved(square(0, 0.2), Affine::translate({-0.1, -0.1, 0.5}))}, 1);
  // a small black leaf over a wide sheet of radiosity .05 x 100: below it nearly that, less its own shadow and what lies beyond 2 m
  for (const Way way : ways) {
    const auto run = run_of(scene, way);
    CAPTURE(static_cast<int>(way));
    CHECK(run.kept.on(0, 0, 0) == Approx(99.0).margin(2.0));
    CHECK(run.kept.on(2, 1, 0) < 5.0);
    CHECK(run.kept.on(2, 1, 0) > 3.5);
  }
}

TEST_CASE("the certificate agrees with the closed form where something lies on the ground") {
  for (const bool front_up : {true, false}) {
    const auto scene = lying(front_up);
    const PlacedScene placed = place(scene);
    const FacetRows rows(scene, placed);
    const RayScene rays(rows);
    CertificateSettings settings;
    const auto traced = trace_organs(scene, rows, rays, choose_organs(rows, settings), settings, silent());
    REQUIRE(traced.light.size() == 1);
    CHECK(traced.light[0].absorbed[0] ==
          Approx(absorbed(sun_irradiance)).margin(4.0 * std::sqrt(traced.light[0].absorbed_variance[0]) + 1e-3));
  }
}
