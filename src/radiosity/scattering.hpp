// Scattered light of a scene: lines, links, iteration, balance.
#pragma once

#include <memory>
#include <string>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/scene/solution.hpp>

#include "lit_elements.hpp"
#include "stored_transport.hpp"

namespace sunfleck {

/// What a solve takes from a store, or leaves there.
struct KeptTransport {
  TransportStore* store = nullptr;  ///< null = nothing is kept
  std::string key;
  std::shared_ptr<const StoredTransport> found;  ///< or null
  double seconds = 0;                            ///< that the elements took, where they were made
};

/// Traces the lines of scattered light (which also bring the sky's direct light into `lit`; the order of its elements is given up), links
/// elements and clusters, iterates, and lets the balance close. What was done, and what escapes of it, goes into `report`.
ScatteredLight solve_scattering(LitElements& lit, const RadiositySettings& settings, const KeptTransport& kept, SolveReport& report,
                                Progress& progress);

}  // namespace sunfleck
