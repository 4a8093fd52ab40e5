// How far from the origin a scene reaches.
#pragma once

#include <string>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Throws InputError for the placement that takes a plant farther than farthest_coordinate. A bound is checked: the sum of the distances by
/// which nested placements move it, and of its own size about its own origin. Plants, placements and circles of groups are checked before.
void check_reach(const Scene& scene);

/// The distance from the origin of the farthest corner of a mesh's faces.
double reach_of(const Mesh& mesh);
/// Bound on the distance from the origin of what lies within `reach` of it, once it is placed.
double reach_of(const Affine& map, double reach);
/// Throws InputError for that key if `reach` is beyond farthest_coordinate.
void check_reach(const Scene& scene, const std::string& key, double reach);

}  // namespace sunfleck
