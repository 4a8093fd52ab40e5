// Convex hulls (Qhull).
#pragma once

#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Triangles of the convex hull, fronts outwards. Points that lie (nearly) in a plane or on a line are given a thickness of 1e-6 of their
/// size. Throws Error if there are fewer than three points or Qhull gives up.
std::vector<Triangle> convex_hull(const std::vector<Triangle>& facets);

}  // namespace sunfleck
