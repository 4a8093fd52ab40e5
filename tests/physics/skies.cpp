// Skies by weather and by picture in every method: closed forms, and integrals by other rules.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

constexpr double pi = std::numbers::pi;

enum class By { direct, clustering, flat, instantiation, reference };
constexpr By all[] = {By::direct, By::clustering, By::flat, By::instantiation, By::reference};
const char* name_of(By by) {
  constexpr const char* names[] = {"direct", "clustering", "flat", "instantiation", "reference"};
  return names[static_cast<int>(by)];
}

Run solve_by(const Scene& scene, By by) {
  if (by == By::reference) return reference_runs::trace(scene, 16384);
  if (by != By::instantiation)
    return solve(scene, by == By::direct ? RadiosityMethod::direct : by == By::flat ? RadiosityMethod::flat : RadiosityMethod::clustering);
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

/// A level, a tilted (40 degrees, towards 120) and an upright plate that faces east and west, far from each other.
Scene plates(double reflectance) {
  auto scene = scene_with({"PAR"}, {uniform_optics("plate", {reflectance}, {0.0})});
  add(scene, "plate", {square(0)}, 0);
  Stance tilted, upright;
  tilted.position = {20, 0, 0}, tilted.tilt_deg = 40, tilted.tilt_azimuth_deg = 120;
  upright.position = {0, 20, 0}, upright.tilt_deg = 90, upright.tilt_azimuth_deg = 90;
  scene.plants[0].placements = {placed({}), placed(tilted), placed(upright)};
  return scene;
}

double on(const Run& run, std::size_t plate, int side = 0) {
  return 0.5 * (run.kept.on(2 * plate, side, 0) + run.kept.on(2 * plate + 1, side, 0));
}

/// By 10^6 directions.
double irradiance(const Sky& sky, const Vec3& normal) {
  double sum = 0;
  constexpr std::uint32_t n = 1'000'000;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double z = (k + 0.5) / n, a = 2.399963229728653 * k, r = std::sqrt(1.0 - z * z);
    const Vec3 d{r * std::cos(a), r * std::sin(a), z};
    sum += sky.irradiance[0] * sky.relative_radiance(d) * std::max(0.0, glm::dot(d, normal)) * 2.0 * pi / n;
  }
  return sum;
}

Sky perez(double clearness, double brightness) {
  Sky sky;
  sky.model = SkyModel::perez;
  sky.irradiance = {100};
  sky.sun = direction_from_angles(40, 150);
  sky.weather = PerezWeather{clearness, brightness};
  prepare_sky(sky, "test");
  return sky;
}

template <class Value>
Sky picture(const Value& value) {
  Panorama p;
  p.columns = 720;
  p.rows = 360;
  for (std::uint32_t row = 0; row < p.rows; ++row)
    for (std::uint32_t column = 0; column < p.columns; ++column)
      p.value.push_back(static_cast<float>(value(p.direction(row + 0.5, column + 0.5))));
  Sky sky;
  sky.model = SkyModel::image;
  sky.irradiance = {100};
  sky.image = std::make_shared<const SkyImage>(std::move(p), "test");
  return sky;
}

}  // namespace

TEST_CASE("plates under Perez's skies and pictures have what these give, in every method", "[sky]") {
  const Sky skies[] = {perez(1.03, 0.3), perez(1.7, 0.35), perez(7, 0.1), picture([](const Vec3& d) { return std::max(0.0, d.z); }),
                       picture([](const Vec3& d) { return 1 + 2 * std::max(0.0, d.x); })};
  for (std::size_t k = 0; k < std::size(skies); ++k)
    for (const By by : all) {
      auto scene = plates(by == By::direct ? 0.1 : 0.0);
      scene.states[0].sky = skies[k];
      const auto run = solve_by(scene, by);
      const Vec3 tilted = glm::normalize(area_vector(run.facets.corners[2])), upright = glm::normalize(area_vector(run.facets.corners[4]));
      CAPTURE(k, name_of(by));
      // few lines meet three plates: what instantiation and the path tracer's 16,384 paths of two facets leave
      const double coarse = by == By::direct ? 0.005 : by == By::instantiation ? 0.05 : by == By::reference ? 0.02 : 0.015;
      CHECK(on(run, 0) == Approx(100.0).epsilon(by == By::direct ? 0.0005 : coarse));
      CHECK(on(run, 1) == Approx(irradiance(skies[k], tilted)).epsilon(coarse));
      CHECK(on(run, 2) == Approx(irradiance(skies[k], upright)).epsilon(coarse));
      CHECK(on(run, 2, 1) == Approx(irradiance(skies[k], -upright)).epsilon(coarse));
    }
}

TEST_CASE("a cosine lobe of a picture has its closed forms in method direct: .2 %", "[sky]") {
  auto scene = plates(0.1);
  scene.states[0].sky = picture([](const Vec3& d) { return std::max(0.0, d.z); });
  const auto run = solve_by(scene, By::direct);
  CHECK(on(run, 0) == Approx(100.0).epsilon(0.002));
  // radiance z lights an upright plane with 2 / 3 of 2 pi / 3
  CHECK(on(run, 2) == Approx(100.0 / pi).epsilon(0.002));
  CHECK(on(run, 2, 1) == Approx(100.0 / pi).epsilon(0.002));
}

TEST_CASE("a narrow bright spot of a picture lights plates from where it stands", "[sky]") {
  // a disc of 2 degrees, too wide and too faint for a sun, with nine tenths of the light, between directions of lines
  const Vec3 spot = direction_from_angles(55, 100);
  const Sky sky = picture([&](const Vec3& d) { return glm::dot(d, spot) > std::cos(2 * pi / 180) ? 9000.0 : 1.0; });
  for (const By by : {By::direct, By::clustering, By::flat}) {
    auto scene = plates(by == By::direct ? 0.1 : 0.0);
    scene.states[0].sky = sky;
    const auto run = solve_by(scene, by);
    const Vec3 tilted = glm::normalize(area_vector(run.facets.corners[2]));
    CAPTURE(name_of(by));
    CHECK(on(run, 0) == Approx(100.0).epsilon(0.01));
    CHECK(on(run, 1) == Approx(irradiance(sky, tilted)).epsilon(by == By::direct ? 0.01 : 0.06));  // moved to the nearest direction
  }
}

TEST_CASE("a canopy under Perez's sky: clustering and flat against path tracing, organ by organ", "[sky]") {
  auto scene = scene_with({"NIR"}, {uniform_optics("leaf", {0.45}, {0.40})});
  scene.periodic = PeriodicCell{0, 0, 1.5, 1};
  scene.ground = flat_ground({1.5, 1}, {0.75, 0.5}, {3, 2}, {0.3});
  add(scene, "canopy", leaves(120, 0.15, {1.5, 1, 0.8}, 5), 0);
  scene.states[0].sky = perez(3.6, 0.2);
  const auto reference = solve_by(scene, By::reference);
  for (const By by : {By::clustering, By::flat}) {
    CAPTURE(name_of(by));
    CHECK(relative_rms(organ_power(solve_by(scene, by)), organ_power(reference)) < 0.025);  // flat 2.3 %; paths leave 1 %
  }
}
