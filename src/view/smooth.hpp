// From one value a facet to values at its corners.
#pragma once

#include <vector>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Corner values: the area-weighted mean over the facets that share the corner (same coordinates to the bit), belong to the same
/// organ (or both to the ground) and meet at less than 60 degrees. `values` is [n][width], the answer [n][3][width].
std::vector<float> smooth_over_organs(const FacetScene& scene, const std::vector<Vec3>& normals, const std::vector<float>& values,
                                      std::size_t width);

}  // namespace sunfleck
