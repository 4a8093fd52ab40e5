// Light for a first look at a scene, in the time that it takes to draw it.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

struct PreviewSettings : SolveSettings {
  /// A ray to the sun from the middle of every facet. Else every side that faces the sun counts as lit, for pictures that trace shadows
  /// themselves (draw_natural()).
  bool trace_sun = false;
};

/// Sun by rays, sky by occlusion (solve_occlusion()), scattered light as a constant of each state and band:
///     E = 1/4 omega E_horizontal,  omega: rho + tau of the plants' materials, the mean over their facets.
/// Lamps and sensors are left out; scenes without sky have the constant alone besides the sun. Nothing of it is a result: the report has
/// method "preview", and no balance that closes.
SolveReport preview_light(const Scene& scene, const PlacedScene& placed, const PreviewSettings& settings, IrradianceSink& sink,
                          Progress& progress);

}  // namespace sunfleck
