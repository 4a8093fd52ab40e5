// The sun's disc where its penumbrae are wider than the leaves that cast and catch them.
#include <catch2/catch.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

/// An endless canopy of LAI 3 and 0.5 m height, its leaves 2 mm wide and black, under a sun whose penumbrae grow to 5 mm; its upper part
/// alone is sharp.
Scene fine_canopy() {
  auto scene = scene_with({"PAR"}, {{"leaf", {0.0f}, {0.0f}, {0.0f}}});
  scene.periodic = PeriodicCell{0, 0, 0.02, 0.02};
  point_sun(scene, {0.3, 0.2, 0.9}, 1000);
  scene.states[0].sun->angular_diameter_deg = 0.53;
  add(scene, "canopy", leaves(300, 0.002, {0.02, 0.02, 0.5}, 7), 0);
  return scene;
}

std::vector<double> lit(const Scene& scene, std::uint32_t points, double lines, std::uint64_t seed) {
  auto settings = settings_of(RadiosityMethod::direct, Quality::standard, seed);
  settings.density.sun_samples = points;
  settings.density.sun_lines_per_organ = lines;
  return organ_power(solve(scene, settings));
}

}  // namespace

TEST_CASE("a sun whose penumbrae are wider than leaves") {
  const auto scene = fine_canopy();
  const auto truth = lit(scene, 256, 100e3, 99);
  // what the choice of points leaves is what as many lines leave of far more points
  const auto chosen = relative_rms(organ_power(solve(scene, RadiosityMethod::direct, Quality::standard, 1)), truth);
  const auto many = relative_rms(lit(scene, 100, density_of(Quality::standard).sun_lines_per_organ, 1), truth);
  CHECK(chosen < 1.5 * many);
  CHECK(chosen < 0.02);
  // a sharp sun is another one: the disc is what this is about
  auto sharp = scene;
  sharp.states[0].sun->angular_diameter_deg = 0;
  CHECK(relative_rms(lit(sharp, 4, 100e3, 99), truth) > 0.1);
}
