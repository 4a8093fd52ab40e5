// What a solve needs against what is free.
#pragma once

#include <cstdint>
#include <string>

#include <sunfleck/core/free_memory.hpp>
#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/scene.hpp>

#include <sunfleck/solver/method_choice.hpp>

namespace sunfleck {

/// More than a solve holds, by the number of its facets, copies and columns alone [bytes]: where that is free, nothing has to be planned.
std::uint64_t generous_bytes(const Scene& scene, const SceneCounts& counts, const MethodChoice& choice);

/// Before copies and ground are laid out: throws OutOfMemory, with numbers, where that alone is more than is free.
void refuse_layout(const Scene& scene, const SceneCounts& counts, const Depth& depth, const FreeMemory& free);

/// Before anything is solved: throws OutOfMemory, with numbers, where the plan of a scene that is not small beside what is free predicts
/// more than that. `program`: bytes that the process held before it read anything.
void refuse_memory(const Scene& scene, const SceneCounts& counts, const MethodChoice& choice, const RunSettings& run,
                   const FreeMemory& free, std::uint64_t program, Progress& progress);

/// Would a solve by another method fit in the place of one that is done? `why_not` says the numbers if not.
bool fits_in_memory(const Scene& scene, const MethodChoice& choice, const RunSettings& run, std::uint64_t program, std::string& why_not,
                    Progress& progress);

}  // namespace sunfleck
