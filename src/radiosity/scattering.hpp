// Scattered light of a scene: lines, links, iteration, balance.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/solution.hpp>

#include "lit_elements.hpp"

namespace sunfleck {

/// Traces the lines of scattered light (which also bring the sky's direct light into `lit`; the order of its elements is given up), links
/// elements and clusters, iterates, and lets the balance close. What was done, and what escapes of it, goes into `report`.
ScatteredLight solve_scattering(LitElements& lit, const RadiositySettings& settings, SolveReport& report, Progress& progress);

}  // namespace sunfleck
