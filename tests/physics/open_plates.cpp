// Plates that nothing hides, under skies and wide suns.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/light/open_light.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

constexpr double pi = std::numbers::pi;

/// A level, a tilted (40 degrees, towards 120) and an upright plate, far from each other.
Scene plates(double reflectance) {
  auto scene = scene_with({"PAR"}, {uniform_optics("plate", {reflectance}, {0.0})});
  add(scene, "plate", {square(0)}, 0);
  Stance tilted, upright;
  tilted.position = {20, 0, 0}, tilted.tilt_deg = 40, tilted.tilt_azimuth_deg = 120;
  upright.position = {0, 20, 0}, upright.tilt_deg = 90;
  scene.plants[0].placements = {placed({}), placed(tilted), placed(upright)};
  return scene;
}

double front(const Run& run, std::size_t plate) {
  return 0.5 * (run.kept.on(2 * plate, 0, 0) + run.kept.on(2 * plate + 1, 0, 0));
}

void sky_of(Scene& scene, SkyModel model) {
  sky(scene, model, 100);
  scene.states[0].sky->sun = glm::normalize(Vec3{0.3, -0.4, 0.8});
  prepare_sky(*scene.states[0].sky, "test");
}

}  // namespace

TEST_CASE("open plates have what the sky gives, level to .2 % and tilted to .5 %: method direct and black surfaces") {
  for (const auto model : {SkyModel::uniform, SkyModel::standard_overcast, SkyModel::clear})
    for (const double reflectance : {0.0, 0.1})
      for (const std::uint64_t seed : {1u, 2u, 3u}) {
        auto scene = plates(reflectance);
        sky_of(scene, model);
        const auto run = solve(scene, reflectance > 0.0 ? RadiosityMethod::direct : RadiosityMethod::clustering, Quality::draft, seed);
        const Vec3 tilted = glm::normalize(area_vector(run.facets.corners[2]));
        // the same integral by another rule: 400,000 directions
        double expected = 0.0;
        constexpr std::uint32_t n = 400'000;
        for (std::uint32_t k = 0; k < n; ++k) {
          const double z = (k + 0.5) / n, a = 2.399963229728653 * k, r = std::sqrt(1.0 - z * z);
          const Vec3 d{r * std::cos(a), r * std::sin(a), z};
          expected += 100.0 * scene.states[0].sky->relative_radiance(d) * std::max(0.0, glm::dot(d, tilted)) * 2.0 * pi / n;
        }
        CAPTURE(static_cast<int>(model), reflectance, seed);
        CHECK(front(run, 0) == Approx(100.0).epsilon(0.002));
        CHECK(front(run, 1) == Approx(expected).epsilon(0.005));
      }
}

TEST_CASE("the open sky on tilted planes: uniform, (1 + cos tilt) / 2") {
  Sky sky;
  sky.model = SkyModel::uniform;
  const OpenSky open(sky);
  for (double tilt = 0; tilt <= 180; tilt += 7)
    CHECK(open.on({std::sin(tilt * pi / 180), 0.0, std::cos(tilt * pi / 180)}) ==
          Approx(0.5 * (1.0 + std::cos(tilt * pi / 180))).margin(0.001));
  sky.model = SkyModel::sphere;
  CHECK(OpenSky(sky).on({0.6, 0.0, -0.8}) == Approx(1.0).margin(0.001));
}

TEST_CASE("a disc of 60 degrees lights both sides of a plate that turns its edge to the centre") {
  // of a disc of angular radius r about the zenith, an upright side has (r - sin r cos r) / (pi sin^2 r) of what faces the centre
  const double r = pi / 6, edge = (r - std::sin(r) * std::cos(r)) / (pi * std::sin(r) * std::sin(r));
  auto scene = plates(0.1);
  point_sun(scene, {0, 0, 1}, 100);
  scene.states[0].sun->angular_diameter_deg = 60;
  const auto check = [&](const Run& run, double epsilon) {
    CHECK(front(run, 0) == Approx(100.0).epsilon(epsilon));
    CHECK(front(run, 1) == Approx(100.0 * std::cos(40 * pi / 180)).epsilon(epsilon));  // all of the disc is above its plane
    for (int side = 0; side < 2; ++side) {
      CHECK(run.kept.on(4, side, 0) == Approx(100.0 * edge).epsilon(5 * epsilon));
      CHECK(run.kept.sunlit[2 * 4 + static_cast<std::size_t>(side)] == Approx(0.5).margin(0.03));
    }
    CHECK(run.kept.sunlit[0] == Approx(1.0).margin(1e-3));
  };
  check(reference_runs::trace(scene, 4096), 0.005);
  check(solve(scene, RadiosityMethod::clustering), 0.003);  // 128 points and more of the disc
  check(solve(scene, RadiosityMethod::direct), 0.003);
}
