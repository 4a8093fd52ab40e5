// What a solve by instantiation will share and take, predicted before it is done.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/instantiation/solve.hpp>

namespace sunfleck {

/// Share of the lines inside copies that other copies, images of their own across a cell's border, or the ground interrupt, and of those
/// that leave copies which meet others from within; root of its mean square by area over copies: from here on errors are of several per
/// cent.
inline constexpr double much_tangled = 0.015;

/// Of scenes with more copies, predictions are made of a part of so many (place()), and take as much of the others.
inline constexpr std::uint64_t most_copies_in_plan = 200'000;

/// What copies share.
struct InstantiationSharing {
  std::uint64_t originals = 0, copies = 0, merged_copies = 0, elements = 0;
  double tangled = 0;               ///< see much_tangled
  std::uint64_t unique_facets = 0;  ///< of all originals, those of copies that were put together among them
  // Of plants that name a policy, while they are closed:
  std::uint64_t pieces = 0;      ///< originals that stand for structures, and for what is in none of them
  std::uint64_t structures = 0;  ///< structures that another stands in for
  std::uint64_t copies_of_pieces = 0;
  std::uint64_t opened_alone = 0;  ///< plants that are opened with their own geometry, one by one
};

/// Traces a pilot of 16 directions through every original. Throws what solve_instantiation() does.
InstantiationSharing plan_sharing(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings, Progress& progress);

/// Counts and bytes of solve_instantiation(), all of what it counts but `sweeps`, which optics decide.
/// - Originals, copies, elements are those of the solve; copies that hardly reach into each other may be put together in one of the two
///   and not in the other.
/// - Meetings of lines: inside originals in proportion to those of pilots; towards the sun from the area that cells turn to it.
/// - Links follow from pilots of 8, 16 and 32 directions through every original: equal links merge, so they grow as a power of the lines.
/// - What is held when is followed step by step in the order of the solve, with the same batches, windows and threads. The iteration is
///   taken to gain a digit a pass, which tells how many fields are kept.
struct InstantiationPlan : InstantiationSharing {
  std::uint64_t links = 0;                                    ///< of the coarse operators
  std::vector<std::pair<std::string, std::uint64_t>> counts;  ///< names as SolveReport::counts has them
  std::vector<std::pair<std::string, std::uint64_t>> memory;  ///< names as SolveReport::memory has them, "at_once" among them
};

InstantiationPlan plan_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                                     Progress& progress);

/// Does anything in a scene repeat so that sharing pays? At least half of the facets of plants are copies of others, and there are enough
/// of them (20,000) that solving them one by one would take longer than a moment.
bool repeats(const Scene& scene);
bool repeats(std::uint64_t facets, std::uint64_t unique);

/// The densities that a scene of so many facets is solved with: large ones take their time from the sun and from the fields, whose errors
/// differ from copy to copy; small ones can afford a finer iteration.
InstantiationDensity adapted(InstantiationDensity density, std::uint64_t facets);

}  // namespace sunfleck
