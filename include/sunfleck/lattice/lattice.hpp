// The D3Q19 lattice on which scattered light moves, after Geist & Steele (2008, "A lighting model for fast rendering of forest ecosystems",
// IEEE Symposium on Interactive Ray Tracing) and Geist, Rasche, Westall & Schalkoff (2004, "Lattice-Boltzmann lighting", Eurographics
// Symposium on Rendering).
#pragma once

#include <array>
#include <cstddef>

namespace sunfleck {

inline constexpr std::size_t lattice_directions = 18;

/// Steps of light in one unit of time [nodes]: 6 along the axes, then 12 along diagonals of faces; one that turns back stands next to its
/// opposite.
inline constexpr std::array<std::array<int, 3>, lattice_directions> lattice_step{{{1, 0, 0},
                                                                                  {-1, 0, 0},
                                                                                  {0, 1, 0},
                                                                                  {0, -1, 0},
                                                                                  {0, 0, 1},
                                                                                  {0, 0, -1},
                                                                                  {1, 1, 0},
                                                                                  {-1, -1, 0},
                                                                                  {1, -1, 0},
                                                                                  {-1, 1, 0},
                                                                                  {1, 0, 1},
                                                                                  {-1, 0, -1},
                                                                                  {1, 0, -1},
                                                                                  {-1, 0, 1},
                                                                                  {0, 1, 1},
                                                                                  {0, -1, -1},
                                                                                  {0, 1, -1},
                                                                                  {0, -1, 1}}};
/// Share of isotropic light that moves along each: 1/12 along axes, 1/24 along diagonals.
constexpr double lattice_weight(std::size_t direction) {
  return direction < 6 ? 1.0 / 12.0 : 1.0 / 24.0;
}

/// [i][j]: density of scattering from direction j into i, of weighted mean 1 over i (sum_i w_i p_ij = 1): Henyey & Greenstein's function of
/// the angle between them. `g` = 1 and -1 send everything straight on or back.
using LatticePhase = std::array<std::array<double, lattice_directions>, lattice_directions>;
LatticePhase lattice_phase(double g);

/// One step at a node: f' = f + Omega f, f_0 (row and column 0) at rest. Rest light is what was absorbed a step before, and goes out again
/// evenly: nodes of leaves take it out.
///     Omega_00 = -1,  Omega_0j = absorption,  Omega_i0 = w_i,  Omega_ij = scattering w_i p_ij - (i == j) (absorption + scattering)
/// Columns sum up to 0: nothing is lost. Diffusion coefficient for g = 0: (2 / sigma_t - 1) / (4 (1 + absorption)) nodes^2 a step.
using LatticeCollision = std::array<std::array<double, lattice_directions + 1>, lattice_directions + 1>;
LatticeCollision lattice_collision(double absorption, double scattering, const LatticePhase& phase);

}  // namespace sunfleck
