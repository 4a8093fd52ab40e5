// In which order copies are opened, and which of them together: the same for a solve and for its plan.
#pragma once

#include <cstdint>
#include <vector>

#include "instantiation/batches.hpp"

namespace sunfleck {

/// Rows of finished copies that wait for their turn, about.
inline constexpr std::size_t opening_window_bytes = std::size_t{96} << 20;

/// Members of one original that are opened together, or one copy that others stand in for.
struct OpeningStep {
  std::uint32_t own = no_parent;       ///< the copy that others stand in for; then there are no batches yet
  std::uint32_t original = no_parent;  ///< of the members
  std::vector<std::uint32_t> members;
  std::vector<Batch> batches;
  bool once = false;  ///< these are all that is opened of the original, in one batch
  bool last = false;  ///< of the original's
};

struct OpeningSteps {
  std::vector<OpeningStep> steps;
  std::vector<std::uint32_t> opened_of_original;  ///< [originals] members with rows
  bool forgets = false;  ///< an original is not asked for again after its last step: nobody shades, or absorbs, by it
};

/// Is any copy of the member opened, by itself?
bool has_rows(const Members& members, const PlacedScene& placed, std::uint32_t m);

/// Members in the order of their copies, in windows whose rows are as large as those that may wait; within a window original by original.
/// Copies that others stand in for come in their turn, one by one.
OpeningSteps opening_steps(const Members& members, const PlacedScene& placed, std::size_t states, std::size_t bands);

/// Members of which rays are kept at the same time, where `runs` are worked on side by side.
inline std::size_t ends_at_once(const std::vector<Batch>& batches, const std::vector<std::pair<std::size_t, std::size_t>>& runs) {
  std::size_t most = 0;
  for (const auto& b : batches) most = std::max(most, b.members.size());
  return most * std::min(runs.size(), threads_at_work());
}

/// Values in each lane of a batch that is opened along an operator of so many fields.
inline std::size_t opening_lanes(const OriginalLight& original, LineOperator::Seen seen, std::size_t fields) {
  const auto& e = original.elements;
  return 3 * 2 * e.size() + (seen == LineOperator::Seen::cells ? 2 * e.surface.cells() : 0) + fields;
}

}  // namespace sunfleck
