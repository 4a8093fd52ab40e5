// Where something lies on the ground, and the two see nothing but each other.
#pragma once

#include <cmath>
#include <cstdint>

#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

/// A cell of the ground is a piece of which a part may be covered by what lies on it. Hits in the covered part belong to the enclosed part
/// of its element (see LineLinks): sun and sky do not shine there, and what lies on it does not see the light of the open part. What is
/// nearer to the ground than a 500th of an element's width counts as lying on it: as much light at most goes astray.
class GroundContact {
 public:
  /// No contact anywhere.
  GroundContact() = default;
  /// Looks down along vertical lines `pitch` apart [m]; costs nothing without ground, or where all plants are above level ground.
  GroundContact(const Elements& elements, double pitch, std::uint64_t seed);

  bool any() const { return elements_ != nullptr; }

  /// Calls cover(k) for hits k of a line of the bundle, which has the hits [begin, end), that are of the ground and covered.
  template <class Cover>
  void each_covered(const LineBundle& bundle, const Vec3& direction, std::uint32_t begin, std::uint32_t end, Cover&& cover) const {
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t row = elements_->row_of_cell[bundle.side[k] >> 1];
      if (elements_->order[row] < elements_->plant_facets) continue;
      const auto& normal = elements_->surface.normal;
      const bool rises = (normal[2][row] > 0.0f) == ((bundle.side[k] & 1u) == 0u);  // the line leaves the ground by its upper side
      if (rises ? k + 1 == end : k == begin) continue;
      const std::uint32_t other = rises ? k + 1 : k - 1;
      if (elements_->order[elements_->row_of_cell[bundle.side[other] >> 1]] >= elements_->plant_facets) continue;
      const double slope = std::fabs(normal[0][row] * direction.x + normal[1][row] * direction.y + normal[2][row] * direction.z);
      const double distance = std::fabs(bundle.depth[other] - bundle.depth[k]) * bundle.depth_to_length * slope;
      if (distance <= reach_) cover(k);
    }
  }

 private:
  const Elements* elements_ = nullptr;
  double reach_ = 0;  ///< [m]
};

}  // namespace sunfleck
