#include "view/picture_frame.hpp"

namespace sunfleck {

Vec3 front_normal(const Triangle& corners) {
  const Vec3 n = area_vector(corners);
  const double length = glm::length(n);
  return length > 0 ? n / length : Vec3{0.0};
}

std::vector<Vec3> framed_points(const FacetScene& scene) {
  const std::size_t end = scene.plant_facets > 0 ? scene.plant_facets : scene.size();
  std::vector<Vec3> points;
  points.reserve(3 * end);
  for (std::size_t f = 0; f < end; ++f)
    if (scene.area[f] > 0) points.insert(points.end(), scene.corners[f].begin(), scene.corners[f].end());
  return points;
}

}  // namespace sunfleck
