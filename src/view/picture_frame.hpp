// What cameras and shading ask of a scene in memory.
#pragma once

#include <vector>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Unit normal of the front; zero where the area is zero.
Vec3 front_normal(const Triangle& corners);

/// Points that the default camera frames: corners of plant facets with area, or of the ground where there are no plants.
std::vector<Vec3> framed_points(const FacetScene& scene);

}  // namespace sunfleck
