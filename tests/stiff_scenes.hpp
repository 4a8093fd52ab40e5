// Scenes that scatter strongly, for the stiffness tests and the table of docs/stiffness-and-extremes.md.
#pragma once

#include <string>

#include "radiosity_runs.hpp"

namespace stiff_scenes {

using namespace radiosity_runs;

/// open: a crown of LAI 8 over soil four times as wide, finite. periodic: a canopy of LAI 8 without end. closed: the same under a lid that
/// lets `lid_transmittance` of the light in and out.
enum class Space { open, periodic, closed };
inline const char* name_of(Space space) {
  return space == Space::open ? "open" : space == Space::periodic ? "periodic" : "closed";
}
inline constexpr double lid_transmittance = 0.01;

/// Leaves scatter the fraction w of what they meet, half of it forward; the lid scatters all.
inline Scene scene_of(Space space, double w, double soil) {
  auto scene = scene_with(
      {"w"}, {uniform_optics("leaf", {0.5 * w}, {0.5 * w}), uniform_optics("lid", {1 - lid_transmittance}, {lid_transmittance})});
  if (space == Space::open) {
    scene.ground = flat_ground({2, 2}, {0.5, 0.5}, {8, 8}, {soil});
  } else {
    scene.periodic = PeriodicCell{0, 0, 1, 1};
    scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {soil});
  }
  sky(scene, SkyModel::uniform, 100);
  point_sun(scene, {0.4, 0.1, 0.7}, 500);
  add(scene, "canopy", leaves(800, 0.1, {1, 1, 0.8}, 4), 0);
  if (space == Space::closed) add(scene, "lid", {square(1.0)}, 1);
  return scene;
}

inline Run solve_stiff(const Scene& scene, RadiosityMethod method, double tolerance = 1e-6) {
  auto settings = settings_of(method, Quality::draft);
  settings.tolerance = tolerance;
  return solve(scene, settings);
}

}  // namespace stiff_scenes
