// Rays through a scene that is not written out: each distinct mesh is one Embree tree, copies are maps into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include <sunfleck/view/drawn_scene.hpp>

namespace sunfleck {

inline constexpr std::size_t no_placed_facet = std::numeric_limits<std::size_t>::max();

/// What a ray meets first.
struct PlacedHit {
  std::size_t facet = no_placed_facet;  ///< row of the result
  float u = 0, v = 0;                   ///< of the mesh's own corners: corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0)
  double distance = std::numeric_limits<double>::infinity();  ///< along the ray [m]
  explicit operator bool() const { return facet != no_placed_facet; }
};

/// A hit with what shading needs of it; corners and u, v as in the world (fronts as solved).
struct SurfacePoint {
  DrawnScene::Place place;
  Triangle corners;  ///< of the image of the scene that is stored, not of the one that the ray met
  double u = 0, v = 0;
  Vec3 normal{0.0};   ///< unit, of the front
  bool front = true;  ///< the side that the ray met
};

/// Ray queries on a DrawnScene, which must outlive it. A tree of trees: the world holds copies of plants and the ground; where writing out
/// the distinct plants would take more than `most_written_out` facets, those that repeat a mesh hold copies of that mesh in turn. Embree
/// knows one level of instances; here a level is a user geometry whose primitives hand the ray on, mapped into the frame of the copy, in
/// double precision, so that the precision does not depend on where a plant stands.
///
/// Memory: about 200 bytes for each facet written out, 100 for each copy. The answers are the same for any number of threads.
class PlacedRays {
 public:
  static constexpr std::size_t most_written_out = std::size_t{1} << 22;

  /// Throws Error if memory does not suffice. `written_out`: for tests of the nested trees.
  explicit PlacedRays(const DrawnScene& scene, std::size_t written_out = most_written_out);
  ~PlacedRays();
  PlacedRays(const PlacedRays&) = delete;
  PlacedRays& operator=(const PlacedRays&) = delete;

  /// Which part of the scene a query asks.
  enum class Part : std::uint8_t {
    all,
    ground,   ///< the ground alone
    repeated  ///< a periodic scene with all its images (finite scenes: all)
  };
  /// The first facet between `from` and `to` [m] along the unit vector `direction`; the facet `start` is left out in the image in which
  /// it is stored. Throws Error if a value is not finite (`to` may be infinite).
  PlacedHit first_hit(const Vec3& origin, const Vec3& direction, Part part = Part::all, double from = 0,
                      double to = std::numeric_limits<double>::infinity(), std::size_t start = no_placed_facet) const;
  bool occluded(const Vec3& origin, const Vec3& direction, Part part = Part::all, std::size_t start = no_placed_facet) const;

  SurfacePoint surface(const PlacedHit& hit, const Vec3& direction) const;

  /// Bytes held by the trees and their geometry, as Embree counted them, and by the copies.
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunfleck
