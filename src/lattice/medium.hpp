// What leaves on a lattice do to light that meets them.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/lattice/lattice.hpp>
#include <sunfleck/lattice/solve.hpp>
#include <sunfleck/plant/optics.hpp>

#include "lattice/clip_triangle.hpp"

namespace sunfleck {

/// Leaf area of one material in one node.
struct NodeArea {
  std::uint32_t node = 0, material = 0;
  double area = 0;  ///< one-sided [m^2]
};

/// Light steps from node to node; at each, the share 1 - sigma_t passes, sigma_s goes out again and sigma_a stays. Where there is ground,
/// it is a plane of nodes below the lowest that takes all, and sends it up.
struct LatticeMedium {
  NodeGrid grid;          ///< of the leaves' nodes
  bool periodic = false;  ///< in x and y
  bool ground = false;    ///< planes of nodes: that of the ground, then those of `grid`
  std::size_t bands = 1;
  std::vector<double> passes;    ///< [b][nodes()] 1 - sigma_t
  std::vector<double> scatters;  ///< [b][nodes()] sigma_s; of the ground 4 x albedo x share of the node that is ground
  std::vector<double> absorbs;   ///< [b][nodes()] sigma_a; of the ground (1 - albedo) x share
  /// [b][nodes of the grid] irradiance on both sides of a leaf together is this times the light in its node over 2 spacing^2.
  std::vector<double> on_leaves;
  std::vector<LatticePhase> phase;  ///< [b]; empty: isotropic

  std::size_t planes() const { return static_cast<std::size_t>(grid.n[2]) + (ground ? 1 : 0); }
  std::size_t nodes() const { return grid.plane() * planes(); }
  /// Row of a node of the grid among nodes().
  std::size_t row(std::uint32_t node) const { return node + (ground ? grid.plane() : 0); }
  std::size_t bytes() const;
};

/// Leaves turned all ways (G = 1/2): k = half their area density, omega = rho + tau (rho the mean of both sides), a = spacing.
///   matched: g = 4/9 (tau - rho) / (tau + rho) is the mean cosine of a leaf's scattering; k_tr = k (1 - omega g),
///            sigma_t = 1 / (1/2 + 2 / (3 k_tr a)), sigma_a = k (1 - omega) a (at most sigma_t), sigma_s = sigma_t - sigma_a, isotropic:
///            the lattice's diffusion length and flux through a surface are those of the leaves.
///   paper:   sigma_t = 1 - exp(-k a), sigma_a = sigma_t (1 - omega), sigma_s = sigma_t omega, Henyey-Greenstein with
///            g = (tau - rho) / (tau + rho), the mean over all leaves.
/// `density`: factor on k: what leaves that stand in clumps, or of a size, catch of each other's light (clumping.hpp). `black`: leaves that
/// keep all. `ground`: null without; `ground_share` [plane] then.
LatticeMedium lattice_medium(const NodeGrid& grid, bool periodic, const std::vector<NodeArea>& leaves, const std::vector<Optics>& materials,
                             const Optics* ground, const std::vector<double>& ground_share, LatticeMapping mapping, double density,
                             bool black, std::size_t bands);

}  // namespace sunfleck
