// From facets to the lattice and back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sunfleck/lattice/solve.hpp>

#include "lattice/facet_cells.hpp"
#include "lattice/steady_state.hpp"

namespace sunfleck {

/// Power that a facet sends on of an irradiance on its sides, both together [W m^-2].
inline double sent_on(const Optics& o, std::size_t band, double front, double back) {
  return (static_cast<double>(o.reflectance_front[band]) + o.transmittance[band]) * front +
         (static_cast<double>(o.reflectance_back[band]) + o.transmittance[band]) * back;
}
/// What it keeps [W m^-2].
inline double kept_of(const Optics& o, std::size_t band, double front, double back) {
  return (1.0 - o.reflectance_front[band] - o.transmittance[band]) * front +
         (1.0 - o.reflectance_back[band] - o.transmittance[band]) * back;
}

struct TwoSides {
  double front = 0, back = 0;
};

/// Which sides of a facet see the scene.
enum class OpenSides : std::uint8_t { both, front, back };
/// [facets] An organ is a body, as a stem is, where its area vectors cancel out (their sum is less than a fifth of its area, as it is not
/// for a leaf) and nearly all its facets look away from its middle, or all towards it. Its inner sides see none of the scene.
std::vector<OpenSides> open_sides(const FacetScene& facets);
/// Leaf area that a facet stands for: bodies hide a fourth of their surface, leaves half of theirs.
inline double leaf_area_of(double area, OpenSides sides) {
  return sides == OpenSides::both ? area : 0.5 * area;
}

/// Scattered light on the sides of a leaf whose front normal is given [W m^-2], from the nodes that it lies in: (phi / 4 -+ J . n / 2) /
/// spacing^2 of each, by its area there; none on a side that is
/// closed off.
TwoSides on_leaf(const LatticeMedium& medium, const LatticeLight& light, std::size_t band, std::span<const CellShare> cells,
                 const Vec3& normal, OpenSides sides);
/// On the ground, from above: what arrives in its nodes over their area.
double on_ground(const LatticeMedium& medium, const LatticeLight& light, std::span<const CellShare> cells);

}  // namespace sunfleck
