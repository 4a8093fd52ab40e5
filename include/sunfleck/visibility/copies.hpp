// Surfaces that are placed many times: rays and the sun's projection through copies that are never written out.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/visibility/surface.hpp>

namespace sunfleck {

/// A copy of a surface: world = map.point(surface.origin + p).
struct SurfaceCopy {
  std::uint32_t surface = 0;  ///< row of CopyScene::surfaces
  Affine map;
};

/// The box about a copy's box, in the world [m].
Box copy_bounds(const Surface& surface, const Affine& map);

/// Surfaces, where they stand, and the ground. Copies may cross the border of a periodic cell.
struct CopyScene {
  std::vector<const Surface*> surfaces;
  std::vector<SurfaceCopy> copies;
  std::vector<Triangle> ground;  ///< as rays meet it, lowered by ground_gap; world [m]
  double ground_gap = 0.0;       ///< see GroundGap [m]
  std::optional<PeriodicCell> periodic;
};

/// What a ray meets first.
struct CopyHit {
  enum class Kind : std::uint8_t { nothing, copy, ground };
  Kind kind = Kind::nothing;
  std::uint32_t index = 0;  ///< copy, or facet of the ground
  Vec3 point{0.0};          ///< in the frame of the image that was met (finite scenes: the world) [m]
  Vec3 image{0.0};          ///< the image met is the copy moved by this [m]
  double distance = 0;      ///< from the ray's origin [m]
};

/// Rays through copies by Embree's instancing: memory of the surfaces and some 500 bytes a copy. Any number of threads may ask.
/// Single precision about the middle of the scene. Periodic scenes: rays are wrapped cell by cell until they have left the heights of
/// the geometry; directions within 1e-4 rad of the horizon are tilted to that.
class CopyRays {
 public:
  /// The scene must outlive it.
  explicit CopyRays(const CopyScene& scene);
  ~CopyRays();
  CopyRays(const CopyRays&) = delete;
  CopyRays& operator=(const CopyRays&) = delete;

  /// The first thing farther than `skip` and within `range` [m] along the unit vector `direction`.
  CopyHit first_hit(const Vec3& origin, const Vec3& direction, double skip, double range = std::numeric_limits<double>::infinity()) const;
  /// The ground within `range` [m], from the origin on and whatever else is there: what lies on it starts no farther away than `skip`.
  CopyHit first_ground(const Vec3& origin, const Vec3& direction, double range) const;
  /// Is there anything within `range` [m]?
  bool occluded(const Vec3& origin, const Vec3& direction, double skip, double range) const;
  /// Rays no longer meet these copies, or meet them again. Not while rays are asked.
  void set_hidden(const std::vector<std::uint32_t>& copies, bool hidden);
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Fraction of each cell of each copy that a direction reaches, in 1/255.
struct LitCells {
  std::vector<std::uint64_t> first;  ///< [copies + 1] row of each copy's first cell
  std::vector<std::uint8_t> lit;     ///< [cells of all copies]
  std::uint64_t fragments = 0;
};

/// Projects copies along each of `directions` (points of the sun's disc) in tiles of 256 x 256 lines, each tile with those copies that
/// reach into it. `pitch` [m]: of each copy, about how far apart the lines are that it is counted with; 0 = it shades, and is not counted.
/// Copies of one pitch are counted together, in tiles that they reach into; all others shade them there, so that what is large does not pay
/// for what is small. Only the depth buffer of a tile and two counts a cell are held. Counts do not saturate.
/// Periodic scenes: lines lower than 1e-3 over the horizon are tilted to that and bring their share (share_of_level_light()).
LitCells lit_cells(const CopyScene& scene, const std::vector<Vec3>& directions, const std::vector<double>& pitch, std::uint64_t seed,
                   Progress& progress);

}  // namespace sunfleck
