// How large, how far apart and how wide things of a scene may be: what single precision and rays through periodic cells can bear.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Throws InputError where a copy stands 4 10^6 of its sizes from the middle of the scene (single precision
/// cannot tell its corners apart there), a sensor stands 10^6 scene sizes from it, or a periodic cell is out of proportion: plants of more
/// than 100,000 times its area, a scene of more than 10,000 times its width in height. Indices of plants and groups must be in range.
void check_extent(const Scene& scene);

/// The most periodic cells that a plant covers, its width times its depth in cells; 1 in finite scenes and where plants are smaller.
double most_cells_covered(const Scene& scene);

/// A note for each plant that covers more than 100 periodic cells: rarely meant, mostly a mistake of units.
std::vector<std::string> notes_on_extent(const Scene& scene);

}  // namespace sunfleck
