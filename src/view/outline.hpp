// The points of a shape that stick out farthest.
#pragma once

#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// The farthest points of all facets with area in 256 directions over the sphere, the six axes first (so that their box is exact in the
/// plant's own frame); plant coordinates [m]. Empty where no facet has area.
std::vector<Vec3> outline_points(const Plant& plant);
std::vector<Vec3> outline_points(const Mesh& mesh);

}  // namespace sunfleck
