// How dense leaves look to each other.
#pragma once

#include <functional>
#include <vector>

#include <sunfleck/visibility/rays.hpp>

#include "lattice/facet_light.hpp"
#include "lattice/steady_state.hpp"

namespace sunfleck {

/// Share of the light that leaves send out evenly on their open sides that meets a leaf again [-], by 2^14 rays from points spread over
/// their area: the recollision probability (Smolander & Stenberg 2003, doi:10.1016/S0034-4257(03)00043-1).
double recollision(const FacetScene& facets, std::size_t leaf_facets, const std::vector<OpenSides>& sides, const RayScene& rays);

/// The same on a lattice: of what nodes send out by their leaf area, the share that black leaves keep.
double recollision(const LatticeMedium& black, const std::vector<NodeArea>& leaves, const Progress& progress);

/// The factor on the leaves' density with which the lattice catches as much as leaves do, between 1/8 and 8, or a thousandth
/// where they catch nothing: `caught(factor)` must rise.
double matching_density(double wanted, const std::function<double(double)>& caught);

}  // namespace sunfleck
