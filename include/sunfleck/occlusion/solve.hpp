// Method occlusion: sky light on every facet from the shape of crowns alone, without a ray to a leaf.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// table: exact for a ball of evenly spread small leaves (BallTable). paper: the formulas of Hegeman et al. 2006.
enum class OcclusionModel { table, paper };
/// "table", "paper".
const std::vector<std::string>& occlusion_model_names();
std::optional<OcclusionModel> occlusion_model_from_name(const std::string& name);

struct OcclusionSettings : SolveSettings {
  OcclusionModel model = OcclusionModel::table;
};

/// Irradiance of sky light on both sides of every facet, after Hegeman, Premoze, Ashikhmin & Drettakis (2006, doi:10.1145/1111411.1111426):
///
///  - A crown is a few ellipsoids of evenly spread leaf area (crown_shells()), each scaled to a ball. A side gets the share of the light
///    about its shell that the ball's model gives: irradiance = V(place in the ball, k R) x E(normal).
///  - E is what the sky brings to a side of that direction, past the other crowns (model table: by the leaf area that 64 rays from the
///    shell's centre meet in their ellipsoids; model paper: all of the sky).
///  - Where crowns cover most of a periodic cell, or of a wide, low stand, they are a layer of leaves, even in the horizontal, with the
///    stand's own profile of leaf area over height (model table), or grass of V = z / h x (1 + cos) / 2 (model paper).
///  - Ground: the same rays from its facets (table); 1 - sum of (r / d)^2 / 2 over the shells about it (paper).
///
/// Sun, lamps and scattered light are left out, and rows say nothing of what the sun reaches. No precomputation but shells and, for each, a table of 256 values. The
/// balance counts what is not absorbed as escaped; `incident` is what facets meet by this estimate. Throws InputError for scenes without
/// sky or with sensors.
SolveReport solve_occlusion(const Scene& scene, const PlacedScene& placed, const OcclusionSettings& settings, IrradianceSink& sink,
                            Progress& progress);

}  // namespace sunfleck
