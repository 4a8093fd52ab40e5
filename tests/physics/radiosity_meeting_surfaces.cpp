// Where surfaces meet and cut through each other, light falls off within what else were one element; judged by path tracing.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <numeric>

#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

/// Blades of grass that start at one point: 12 mm wide at the base, where each cuts through all others, and 0.2 m long.
Scene tuft() {
  auto scene = scene_with({"P", "N"}, {{"leaf", {0.08f, 0.45f}, {0.12f, 0.48f}, {0.05f, 0.42f}}});
  sky(scene, SkyModel::standard_overcast, 90);
  point_sun(scene, {0.4, 0.5, 0.8}, 400);
  std::vector<Mesh> blades;
  for (int i = 0; i < 40; ++i) {
    const double azimuth = 2.399963 * i, tilt = 0.1 + 0.5 * std::fmod(0.618034 * i, 1.0);
    const Vec3 side = Vec3{-std::sin(azimuth), std::cos(azimuth), 0};
    const Vec3 tip = 0.2 * Vec3{std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
    blades.push_back({{-0.006 * side, 0.006 * side, tip + 0.004 * side, tip - 0.004 * side}, {{0, 1, 2}, {0, 2, 3}}});
  }
  add(scene, "tuft", std::move(blades), 0);
  return scene;
}

double total(const Run& run, std::size_t band) {
  const auto power = organ_power(run, band);
  return std::accumulate(power.begin(), power.end(), 0.0);
}

}  // namespace

TEST_CASE("meeting surfaces: a tuft of grass keeps what path tracing says", "[radiosity]") {
  const auto scene = tuft();
  const auto truth = reference_runs::trace(scene, 4096);
  // without shades 10 % and more in N; instantiation does not send by cells
  const auto check = [&](const Run& run, std::array<double, 2> limits) {
    for (std::size_t band = 0; band < 2; ++band) {
      const double bias = total(run, band) / total(truth, band) - 1;
      CAPTURE(band, bias);
      CHECK(std::fabs(bias) < limits[band]);
    }
  };
  for (const auto method : both_methods) {
    CAPTURE(name_of(method));
    check(solve(scene, method), {0.01, 0.015});
  }
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(Quality::standard);
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  CAPTURE("instantiation");
  check({std::move(facets), std::move(kept), std::move(report)}, {0.02, 0.025});
}
