// Groups that a scene repeats, and copies of plants that are placed with a shear.
#pragma once

#include <sunfleck/policy/classes.hpp>

namespace sunfleck {

/// Adds a class for each group with at least two placed copies, and classes of their own for placements that shear or stretch.
void add_whole_copies(const Scene& scene, Classification& out);

}  // namespace sunfleck
