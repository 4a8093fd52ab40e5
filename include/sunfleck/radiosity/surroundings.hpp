// A scene as rays see it, however its geometry and its light are kept: what lamps and sensors need to know of it.
#pragma once

#include <cstdint>
#include <functional>

#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// All calls may come from any number of threads, and must give the same answer in each. s states, b bands.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Does anything stand within `range` [m] along the unit vector? `start`: the facet on which the origin lies, or no_facet.
  virtual bool blocked(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const = 0;
  /// Radiosity [s * b] of the side that a ray meets first [W m^-2]: all light that leaves it, reflected and transmitted; false if
  /// the ray leaves the scene.
  virtual bool radiosity(const Vec3& origin, const Vec3& direction, float* values) const = 0;
  /// Rays that start off a facet or end at a lamp keep this far from them [m]: above the rounding of rays.
  virtual double clearance() const = 0;
};

/// A scene with every copy written out.
class FacetSurroundings final : public Surroundings {
 public:
  /// Radiosity [s * b] of a side at corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0).
  using Lookup = std::function<void(std::uint32_t facet, bool front, double u, double v, float* values)>;
  /// Both must outlive this; `lookup` may be empty if radiosity() is never called.
  FacetSurroundings(const FacetScene& facets, const RayScene& rays, Lookup lookup = {});

  bool blocked(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const override;
  bool radiosity(const Vec3& origin, const Vec3& direction, float* values) const override;
  double clearance() const override { return clearance_; }

 private:
  const RayScene& rays_;
  Lookup lookup_;
  double clearance_;
};

/// Clearance for rays through geometry kept in single precision over these bounds (and cell).
double ray_clearance(const Box& bounds, const std::optional<PeriodicCell>& cell);

}  // namespace sunfleck
