// How finely originals of few patches are cut: light on a wall varies as its surroundings do, not as its own size tells.
#pragma once

#include <vector>

#include <sunfleck/scene/facets.hpp>

#include "instantiation/originals.hpp"

namespace sunfleck {

/// Per original, the patches of surface (scene/patches.hpp) that it is cut into elements and sampled by lines as if it had, at least [-].
/// Densities are per patch, and a house of five walls, or a box with a leaf in it, would be ten elements. Originals of at most 20 patches
/// and 8 members have 200; others are cut as far as the mean patch of the scene is smaller than theirs, up to 200 as well. 0 = it is left
/// as it is: pieces of plants.
std::vector<double> fewest_organs(const Scene& scene, const Originals& originals);

/// How many times smaller than its mean patch the one is that an original of these facets is cut and sampled by, at least 1: so that it has
/// `fewest_organs`, and, up to 4, so that a few patches that hold most of the area (a house put together with its plants) do not make the
/// others share elements: the mean without the largest hundredth of the patches.
double times_finer(const FacetScene& facets, double fewest_organs);

}  // namespace sunfleck
