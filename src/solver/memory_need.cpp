#include "solver/memory_need.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>

#include "solver/bytes_of_scene.hpp"
#include <sunfleck/solver/plan.hpp>
#include "solver/second_try.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

std::string text_of(std::uint64_t bytes) {
  return bytes_text(static_cast<double>(bytes));
}

std::string free_text(const FreeMemory& free) {
  return fmt::format("{} {} are free", text_of(free.bytes), free.limit);
}

/// What the process may come to hold: what is free, and what it holds already.
std::uint64_t room(const FreeMemory& free) {
  return free.bytes + std::min<std::uint64_t>(resident_bytes(), std::numeric_limits<std::uint64_t>::max() - free.bytes);
}

std::string label(const Scene& scene) {
  return scene.file.empty() ? "the scene" : scene.file;
}

/// By its plan; by what the facets alone take where not even that fits.
bool fits(const Scene& scene, const SceneCounts& counts, const MethodChoice& choice, const FreeMemory& free, const RunSettings& run,
          std::uint64_t program, std::string& why_not, Progress& progress) {
  const std::uint64_t least = choice.method == "instantiation" ? 0 : layout_bytes(counts) + expanded_bytes(counts);
  const bool surely_not = least > room(free);
  const std::uint64_t needed = surely_not ? least : make_plan(scene, choice, run, progress, program).memory_total();
  if (needed <= room(free)) return true;
  why_not = fmt::format("needs {} {}, {}", surely_not ? "at least" : "about", text_of(needed), free_text(free));
  return false;
}

}  // namespace

std::uint64_t generous_bytes(const Scene& scene, const SceneCounts& counts, const MethodChoice& choice) {
  const std::uint64_t columns = scene.states.size() * scene.band_count();
  // measured up to 2, 4 and 7 kB a facet with two columns (docs/accuracy.md); half a kB more a column
  const auto of_facet = static_cast<std::uint64_t>(3'000 * std::exp2(fineness_of(choice)));
  constexpr std::uint64_t of_column = 500, of_copy = 100'000, start = 200'000'000;
  if (choice.method == "instantiation")
    return start + (counts.unique_facets + counts.ground_facets) * (of_facet + of_column * columns) +
           copies_of(counts) * (of_copy + of_column * columns);
  const std::uint64_t pairs = choice.method == "flat" ? 3 : 1;  // every facet with every other that it sees
  return start + counts.facets() * (pairs * of_facet + of_column * columns) + copies_of(counts) * 200;
}

void refuse_layout(const Scene& scene, const SceneCounts& counts, const Depth& depth, const FreeMemory& free) {
  const std::uint64_t least = depth.whole() ? layout_bytes(counts) : 0;
  if (least > room(free))
    throw OutOfMemory(fmt::format("{}: its {} and {} of the ground take {} before anything is solved, {}; fewer copies or ground cells",
                                  label(scene), counted(copies_of(counts), "copy", "copies"),
                                  counted(counts.ground_facets, "facet", "facets"), text_of(least), free_text(free)));
}

void refuse_memory(const Scene& scene, const SceneCounts& counts, const MethodChoice& choice, const RunSettings& run,
                   const FreeMemory& free, std::uint64_t program, Progress& progress) {
  std::string why_not;
  if (generous_bytes(scene, counts, choice) > room(free) && !fits(scene, counts, choice, free, run, program, why_not, progress))
    throw OutOfMemory(fmt::format("{}: method {} at quality {} {}", label(scene), choice.method, name_of(choice.quality), why_not));
}

bool fits_in_memory(const Scene& scene, const MethodChoice& choice, const RunSettings& run, std::uint64_t program, std::string& why_not,
                    Progress& progress) {
  const auto free = free_memory();
  const auto counts = count(scene);
  if (generous_bytes(scene, counts, choice) <= room(free)) return true;
  return fits(scene, counts, choice, free, run, program, why_not, progress);
}

}  // namespace sunfleck
