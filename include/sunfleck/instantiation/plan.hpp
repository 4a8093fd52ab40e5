// What a solve by instantiation will share and take, predicted before it is done.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/instantiation/solve.hpp>

namespace sunfleck {

/// Counts and bytes of solve_instantiation(). Originals, copies, elements and rays are exact; links follow from pilots of 8 and 16
/// directions through every original: equal links merge, so they grow as a power of the lines, whose exponent the two pilots give.
struct InstantiationPlan {
  std::uint64_t originals = 0, copies = 0, merged_copies = 0, elements = 0;
  std::uint64_t links = 0;  ///< of the coarse operators
  double tangled = 0;       ///< mean share of lines inside copies that meet another copy: above 1 % the method loses accuracy
  std::vector<std::pair<std::string, std::uint64_t>> memory;  ///< names as SolveReport::memory has them
  std::uint64_t memory_total() const;
};

InstantiationPlan plan_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                                     Progress& progress);

/// Does anything in a scene repeat so that sharing pays? At least half of the facets of plants are copies of others, and there are enough
/// of them (20,000) that solving them one by one would take longer than a moment.
bool repeats(const Scene& scene);

/// The densities that a scene of so many facets is solved with.
InstantiationDensity adapted(InstantiationDensity density, std::uint64_t facets);

}  // namespace sunfleck
