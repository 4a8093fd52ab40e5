// Sampling densities between and beyond the named qualities.
#pragma once

#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

/// How fine a solve is, continuously: 0 is draft, 1 standard, 2 fine.
inline constexpr double coarsest_fineness = 0.0, finest_fineness = 3.0;

/// Densities at a fineness, clamped to its range. At 0, 1 and 2 those of density_of(); between them every density is the weighted
/// geometric mean of its neighbours', counts rounded; beyond 2 it grows on by the same factors a unit: 1.4 for directions and lines, 1.5
/// for elements, 1.6 for the sky, 2.5 for the sun's lines; thresholds shrink.
RadiosityDensity density_at(double fineness);

}  // namespace sunfleck
