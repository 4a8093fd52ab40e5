// The crown of a plant as a few ellipsoids of evenly spread leaf area.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// An ellipsoid whose surface has the second moments of the leaf area that it stands for: a ball of even density has a fifth of its squared
/// radius as variance along each axis.
struct CrownShell {
  Vec3 centre{0.0};         ///< [m]
  Mat3 to_ball{1.0};        ///< offsets from the centre -> the unit ball
  double radius = 1;        ///< of the ball of its volume [m]
  double leaf_area = 0;     ///< one-sided [m^2]
  double other_leaves = 1;  ///< share of the leaf area that shades a leaf: all but the leaf itself [-]

  /// k [m^-1]: half the density of what shades (leaves turned all ways hide half their area, G = 1/2).
  double extinction() const;
  double optical_radius() const { return extinction() * radius; }
  /// Length of the ray from `origin` towards the unit vector `direction` within the ellipsoid, between `from` and `to` [m].
  double chord(const Vec3& origin, const Vec3& direction, double from, double to) const;
  /// Half its extent along x, y and z [m].
  Vec3 half_extent() const;
  /// The same ellipsoid moved by a map; leaf area as that scales volumes, to the power 2/3.
  CrownShell placed(const Affine& map) const;
};

struct CrownShells {
  std::vector<CrownShell> shells;      ///< frame of the plant
  std::vector<std::uint8_t> of_facet;  ///< [facets of the plant] row of `shells`
  static constexpr int most_shells = 64;
};

/// Splits a plant along the longest axis of what is left, as often as that lets the ellipsoids shrink to less than .7 of their volume: a
/// ball stays one, tufts at the ends of branches become one each. What is split are runs of at most 64 facets of an organ. Every facet
/// with an area must have one finite place; a plant without any has one shell without leaves.
CrownShells crown_shells(const Plant& plant);

}  // namespace sunfleck
