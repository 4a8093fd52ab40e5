// Camera rays on a scene that must be seen at once.
#pragma once

#include <cstddef>
#include <memory>

#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// First hits on the facets of a scene, from a tree that all cores build in a fraction of the time RayScene takes: no period, no
/// stacked facets (which of two leaves on each other is met is left open), no watertight edges. For a picture until the RayScene is there.
class QuickRays {
 public:
  /// The scene must outlive it. Throws Error if memory does not suffice.
  explicit QuickRays(const FacetScene& scene);
  ~QuickRays();
  QuickRays(const QuickRays&) = delete;
  QuickRays& operator=(const QuickRays&) = delete;

  /// The first facet other than `start` within `range` [m] along the unit vector `direction`; from any number of threads.
  RayHit first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start = no_facet,
                   double range = std::numeric_limits<double>::infinity()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
