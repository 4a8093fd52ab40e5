// What a solve would do and leave out, found from the scene alone.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/scene.hpp>

#include "cli/method_choice.hpp"

namespace sunfleck {

struct PlanItem {
  std::string name;
  bool done = true;
  std::string why;  ///< what is done, or why it is left out
};

struct Plan {
  MethodChoice choice;
  SceneCounts counts;
  std::vector<PlanItem> items;
  std::vector<std::pair<std::string, std::uint64_t>> memory;  ///< bytes per part, predicted; not all are held at the same time
  std::vector<std::pair<std::string, std::uint64_t>> work;    ///< predicted counts
  std::uint64_t memory_total() const;
};

/// Lays the scene's copies out (up to 20 million facets) and traces a pilot of few lines to predict links.
Plan make_plan(const Scene& scene, const MethodChoice& choice, Progress& progress);

}  // namespace sunfleck
