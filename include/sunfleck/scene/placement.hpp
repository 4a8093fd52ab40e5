// Where a copy of something stands.
#pragma once

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// A copy of a plant, group or lamp: local frame -> frame of what holds it.
struct Placement {
  Affine map;
};

}  // namespace sunfleck
