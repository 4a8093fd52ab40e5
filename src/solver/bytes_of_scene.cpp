#include "solver/bytes_of_scene.hpp"

#include <algorithm>
#include <string>

#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t name = sizeof(std::string), row = sizeof(std::uint32_t);

}  // namespace

std::uint64_t copies_of(const SceneCounts& counts) {
  std::uint64_t copies = 0;
  for (const auto c : counts.copies) copies += c;
  return copies;
}

std::uint64_t layout_bytes(const SceneCounts& counts) {
  const std::uint64_t of_writer = name + 3 * row;  // an organ of the ground has a name of its own
  return copies_of(counts) * (sizeof(PlacedCopy) + 2 * name) + counts.ground_organs * of_writer;
}

std::uint64_t expanded_bytes(const SceneCounts& counts) {
  return counts.facets() * (sizeof(Triangle) + sizeof(float) + 2 * row) + counts.organs * 5 * row + counts.ground_organs * name;
}

std::uint64_t tree_bytes(const SceneCounts& counts) {
  constexpr std::uint64_t of_facet = 300;
  return counts.facets() * of_facet;
}

std::uint64_t row_bytes(const Scene& scene, const SceneCounts& counts) {
  const std::uint64_t columns = scene.states.size() * scene.band_count();
  const std::uint64_t of_organ = (3 * columns + 2 * scene.states.size() + 1) * sizeof(double);
  constexpr std::uint64_t chunks = 20 << 20;
  return std::max(counts.largest_plant_organs, counts.ground_organs) * of_organ +
         std::min(chunks, counts.facets() * result_bytes_per_facet(scene));
}

std::uint64_t solution_bytes_per_facet(const Scene& scene) {
  return scene.states.size() * 2 * (scene.band_count() + 1) * sizeof(float);
}

std::uint64_t result_bytes_per_facet(const Scene& scene) {
  return scene.states.size() * (3 * scene.band_count() + 2) * sizeof(float) + sizeof(float) + 3 * sizeof(double) + sizeof(std::uint32_t);
}

}  // namespace sunfleck
