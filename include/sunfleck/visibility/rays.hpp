// Rays through the facets of a scene, finite or periodic (Embree).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

inline constexpr std::uint32_t no_facet = 0xffffffffu;

/// What a ray meets first.
struct RayHit {
  std::uint32_t facet = no_facet;  ///< row of FacetScene, or facet of the copy; no_facet = nothing
  std::uint32_t copy = 0;          ///< as in CopyFacet; always 0 if the rays are of a FacetScene
  bool front = true;               ///< which side is met
  double u = 0, v = 0;             ///< the point is corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0), in any image
  double distance = std::numeric_limits<double>::infinity();  ///< along the ray [m]

  explicit operator bool() const { return facet != no_facet; }
  CopyFacet where() const { return {copy, facet}; }
};

/// Where a ray starts that starts on no facet.
inline constexpr CopyFacet nowhere{0, no_facet};

/// Ray queries on a FacetScene or on the copies of a FacetRows, which must outlive it. All queries may run in any number of threads; the
/// answers do not depend on it.
///
/// Geometry is kept in single precision relative to the middle of the scene, in units of its size: surfaces nearer to each other
/// than 1e-6 of the scene's size are told apart only if they are *stacked* (below). Facets without area are left out.
///
/// Rays that start on a facet name it (`start`): it is left out by its number, so no offset is needed. Facets that lie exactly on
/// each other (parallel within 1e-6 rad, planes nearer than 4e-7 of the scene's size, overlapping) are stacked: their order is
/// that of their planes in double precision where these differ, else the facet with the higher row lies on the side of positive
/// z (or y, or x where that is zero) of the common normal. Light between them is therefore exchanged as between leaves with a
/// vanishing gap.
///
/// In a periodic scene the ray is wrapped cell by cell without a limit on their number, until it has left the geometry's range of
/// heights. To make that end, directions within 1e-6 rad of the horizon are turned to 1e-6 above or below. Images of a facet
/// are seen by the facet itself.
///
/// Copies of a FacetRows are instances of their plant's geometry, which is kept once, about the plant's middle: memory is that of the
/// plants, the ground and some 500 bytes a copy. Facets are then named by copy (CopyFacet). Only facets of the same copy are stacked: where
/// whole copies lie in each other, single precision decides which is met first.
class RayScene {
 public:
  /// Throws InputError if facets reach over absurdly many periodic cells (a mistake of units), Error if memory does not suffice.
  explicit RayScene(const FacetScene& scene);
  explicit RayScene(const FacetRows& rows);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// The first facet within `range` [m] along the unit vector `direction`. `start`: the facet on which `origin` lies.
  /// Throws Error if origin or direction is not finite.
  RayHit first_hit(const Vec3& origin, const Vec3& direction, CopyFacet start,
                   double range = std::numeric_limits<double>::infinity()) const;
  RayHit first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start = no_facet,
                   double range = std::numeric_limits<double>::infinity()) const {
    return first_hit(origin, direction, CopyFacet{0, start}, range);
  }
  /// True if any facet stands within `range` [m] along the unit vector `direction`.
  bool occluded(const Vec3& origin, const Vec3& direction, CopyFacet start, double range = std::numeric_limits<double>::infinity()) const;
  bool occluded(const Vec3& origin, const Vec3& direction, std::uint32_t start = no_facet,
                double range = std::numeric_limits<double>::infinity()) const {
    return occluded(origin, direction, CopyFacet{0, start}, range);
  }

  /// The facet at a row of the result: {0, row} if the rays are of a FacetScene.
  CopyFacet at(std::uint64_t row) const;
  std::uint64_t facet_count() const;
  std::uint64_t plant_facets() const;  ///< rows below are of plants, the others of the ground
  Triangle corners(CopyFacet facet) const;
  /// As rays meet it: the ground lies lower than it is given, see GroundGap. Rays that go on from a facet start on these.
  Triangle met_corners(CopyFacet facet) const;
  std::uint32_t material(CopyFacet facet) const;
  const std::vector<Optics>& materials() const;
  /// Of facets with area; of copies the boxes about their plants' boxes.
  const Box& bounds() const;
  const std::optional<PeriodicCell>& periodic() const;

  /// Bytes held by the acceleration structure and its copy of the geometry, counted as they were allocated.
  std::size_t bytes() const;
  /// Pairs of facets that lie on each other.
  std::size_t stacked_pairs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
