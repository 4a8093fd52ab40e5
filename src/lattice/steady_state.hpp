// The light that stays on a lattice once all that is sent in leaves or is absorbed.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <sunfleck/core/progress.hpp>

#include "lattice/medium.hpp"

namespace sunfleck {

/// Light that comes into a node at the border along a direction [W]; by node coordinates. Empty: none.
using LatticeInflow = std::function<double(std::size_t direction, std::int64_t x, std::int64_t y, std::int64_t z)>;

/// One band of one state.
struct LatticeColumn {
  std::size_t band = 0;
  std::vector<double> source;  ///< [nodes()] sent out evenly [W]; of the ground four times that
  LatticeInflow inflow;
};

struct LatticeLight {
  std::vector<double> light;    ///< [nodes()] phi: sum of what comes into each node along all directions [W]
  std::vector<double> flux[3];  ///< [nodes()] the same times the direction's unit vector [W]
  double escaped = 0;           ///< [W]
};

struct SteadyState {
  std::vector<LatticeLight> columns;
  std::uint32_t iterations = 0;
  double residual = 0;  ///< of phi, weighted by the root of sigma_s, over that of the first flight; the worst column
};

struct SteadySettings {
  double tolerance = 1e-7;
  std::uint32_t most_iterations = 2000;
};

/// Isotropic scattering: conjugate gradients on psi = sigma_s^(1/2) phi, (1 - sigma_s^(1/2) T sigma_s^(1/2)) psi = sigma_s^(1/2) T q, where
/// T is a sweep: symmetric, as light takes the same way back. Else: sweep after sweep. Calls `iterated(iteration, residual)` after each.
SteadyState steady_state(const LatticeMedium& medium, std::vector<LatticeColumn>& columns, const SteadySettings& settings,
                         const Progress& progress, const std::function<void(std::uint32_t, double)>& iterated);

}  // namespace sunfleck
