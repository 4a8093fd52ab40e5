// What lies on the ground lies above it.
#pragma once

#include <sunfleck/core/vector.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Lines and rays meet the ground this much lower than it is given [m], in all methods and in the reference alike: what coincides with the
/// ground, whichever side it turns up, or is less than this below it, lies on it. It hides the ground and is lit from above; its lower
/// side sees the ground, which is dark there.
///     gap = max(2.5e-6 x size of the plants, 1e-6 x size of all),
/// sizes being the longest edge of a box: some times what single precision rounds away, and less than the clearance from which sensors
/// look. Over level ground with every facet written out, heights do not suffer from wide ground, and the gap is 2.5e-6 x size of the plants
/// alone.
class GroundGap {
 public:
  GroundGap() = default;
  explicit GroundGap(const FacetScene& scene);
  /// Zero where there is no plant.
  GroundGap(const Box& plants, const Box& all);

  double metres() const { return metres_; }
  /// A facet of the ground as it is met.
  Triangle lowered(Triangle facet) const {
    for (auto& corner : facet) corner.z -= metres_;
    return facet;
  }

 private:
  double metres_ = 0.0;
};

/// Are all corners of the ground at one height? True without ground.
bool ground_is_level(const FacetScene& scene);

/// The box of the plants' facets that have an area.
Box plant_bounds(const FacetScene& scene);

}  // namespace sunfleck
