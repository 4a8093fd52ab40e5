#include <sunfleck/radiosity/surroundings.hpp>

#include <algorithm>

namespace sunfleck {

double ray_clearance(const Box& bounds, const std::optional<PeriodicCell>& cell) {
  const Vec3 size = bounds.size();
  double largest = std::max({size.x, size.y, size.z});
  if (cell) largest = std::max({largest, cell->width(), cell->depth()});
  return 4e-6 * largest;  // RayScene tells apart what is farther than 1e-6 of the scene's size
}

FacetSurroundings::FacetSurroundings(const FacetScene& facets, const RayScene& rays, Lookup lookup)
    : rays_(rays), lookup_(std::move(lookup)), clearance_(ray_clearance(facets.bounds, facets.periodic)) {}

bool FacetSurroundings::blocked(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const {
  return rays_.occluded(origin, direction, start, range);
}

bool FacetSurroundings::radiosity(const Vec3& origin, const Vec3& direction, float* values) const {
  const RayHit hit = rays_.first_hit(origin, direction);
  if (!hit) return false;
  lookup_(hit.facet, hit.front, hit.u, hit.v, values);
  return true;
}

}  // namespace sunfleck
