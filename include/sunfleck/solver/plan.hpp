// What a solve would do and leave out, found from the scene alone.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/scene.hpp>

#include <sunfleck/solver/method_choice.hpp>

namespace sunfleck {

struct PlanItem {
  std::string name;
  bool done = true;
  std::string why;  ///< what is done, or why it is left out
};

/// A part of the memory or of the work, predicted.
struct PlanFigure {
  std::string name;  ///< as a result has it in /memory or /counts, where it counts the same
  std::string what;
  std::uint64_t amount = 0;
};

struct Plan {
  MethodChoice choice;
  SceneCounts counts;
  std::vector<PlanItem> items;
  std::vector<PlanFigure> memory;  ///< bytes per part; not all are held at the same time
  std::vector<PlanFigure> work;
  std::uint64_t at_once = 0;  ///< the most bytes of all parts at one time; 0 if that is not known
  /// The most at one time, or where that is not known the sum of all parts.
  std::uint64_t memory_total() const;
};

/// Lays the scene's copies out (up to 20 million facets; instantiation: its originals) and traces a pilot of few lines to predict links.
/// `program`: bytes that the process held before it read anything.
Plan make_plan(const Scene& scene, const MethodChoice& choice, const RunSettings& run, Progress& progress, std::uint64_t program = 0);

}  // namespace sunfleck
