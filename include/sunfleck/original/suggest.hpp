// How alike the members of a class are by their own tables, and the policy that such differences suggest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/original/originals.hpp>

namespace sunfleck {

/// Root mean square, over members of a class, of the difference between a member's own S and the representative's under its map, relative
/// to the member's S; and the same of sigma.
struct ClassSpread {
  std::size_t members = 0;    ///< measured, the representative not among them
  std::vector<double> phase;  ///< [bands] [-]
  double sigma = 0;           ///< [-]
  double noise = 0;           ///< what sampling alone would show in `phase` [-]
};

/// Measures the representative and up to `most` other members, evenly picked, with harmonics of order 2 to a sampling error of `error`.
ClassSpread class_spread(const Scene& scene, const OriginalClass& original, std::size_t most, double error, Progress& progress);

struct SuggestSettings {
  std::size_t measured = 48;  ///< structures of each type, evenly picked by area
  double likeness = 0.1;      ///< wanted rms difference of S from the mean of its class, relative [-]
  double error = 0.03;        ///< sampling error of each measurement [-]
  std::uint32_t least_members = 3;
  std::uint64_t most_facets = 50000;  ///< larger structures are not measured
};

struct PolicySuggestion {
  Policy policy;
  std::vector<std::string> remarks;  ///< what it was derived from, per type: for comments
};

/// For each structure type with enough structures that are in no exact class: their S per area is measured and turned in either way of
/// Alignment, of which the better is taken; the parameter is chosen along which cutting into intervals leaves the least differences within
/// classes, cut (each time where it helps most) until the likeness is reached or cuts no longer help; then a second parameter if it takes
/// away another fifth. Whole plants count as a type where a scene has enough of them. All plants of the scene are taken as one species.
/// Throws InputError if no type has enough structures.
PolicySuggestion suggest_policy(const Scene& scene, const SuggestSettings& settings, Progress& progress);

}  // namespace sunfleck
