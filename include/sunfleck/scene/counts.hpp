// Sizes of a scene, known before any copy is written out.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// More copies than any scene can hold: where groups of groups multiply beyond it, counts stay here instead of wrapping around.
inline constexpr std::uint64_t too_many_copies = std::uint64_t{1} << 32;

/// A number of copies for messages: "at least 4294967296" where counting ended.
std::string copies_text(std::uint64_t copies);

/// Per row of Scene::plants: placed copies, through groups of any depth, at most too_many_copies. No cycle among groups.
std::vector<std::uint64_t> placed_copies(const Scene& scene);

/// Per row of Scene::plants: copies that a plant or group holds, at most too_many_copies.
std::vector<std::uint64_t> copies_inside(const Scene& scene, bool is_group, std::uint32_t index);

struct SceneCounts {
  std::vector<std::uint64_t> copies;  ///< per row of Scene::plants: placed copies, through groups of any depth
  std::uint64_t plant_facets = 0;     ///< of all copies
  std::uint64_t unique_facets = 0;    ///< of plants that are placed at least once, each counted once
  std::uint64_t ground_facets = 0;
  std::uint64_t organs = 0;                ///< structures with shapes in all copies, and the rows that the ground has
  std::uint64_t ground_organs = 0;         ///< the latter
  std::uint64_t largest_plant_organs = 0;  ///< of one copy
  double leaf_area = 0;                    ///< one-sided area of all plant facets, without the scales of placements [m^2]
  std::uint64_t facets() const { return plant_facets + ground_facets; }
};

/// Bytes that the plants of a scene hold, each once, with what the scene knows of their shapes.
std::uint64_t held_bytes(const Scene& scene);

/// The scene must have passed check_scene() (no cycle among groups).
SceneCounts count(const Scene& scene);

}  // namespace sunfleck
