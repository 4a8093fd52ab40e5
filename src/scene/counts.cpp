#include <sunfleck/scene/counts.hpp>

#include <algorithm>
#include <optional>
#include <unordered_set>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/plant/describe.hpp>

namespace sunfleck {

namespace {

/// Copies per plant that one copy of a group holds; each group is worked out once, however often it is placed.
class GroupContents {
 public:
  explicit GroupContents(const Scene& scene) : scene_(scene), known_(scene.groups.size()) {}

  const std::vector<std::uint64_t>& of(std::uint32_t group) {
    if (known_[group]) return *known_[group];
    std::vector<std::uint64_t> copies(scene_.plants.size(), 0);
    for (const auto& member : scene_.groups[group].members) {
      if (!member.is_group) {
        ++copies[member.index];
        continue;
      }
      const auto& inner = of(member.index);
      for (std::size_t p = 0; p < copies.size(); ++p) copies[p] = std::min(too_many_copies, copies[p] + inner[p]);
    }
    known_[group] = std::move(copies);
    return *known_[group];
  }

 private:
  const Scene& scene_;
  std::vector<std::optional<std::vector<std::uint64_t>>> known_;
};

std::uint64_t ground_facets(const Scene& scene) {
  if (!scene.ground) return 0;
  if (scene.ground->mesh) return scene.ground->mesh->triangles.size();
  return std::uint64_t{2} * scene.ground->cells[0] * scene.ground->cells[1];
}

std::uint64_t ground_organs(const Scene& scene) {
  if (!scene.ground) return 0;
  return scene.ground->mesh ? 1 : std::uint64_t{scene.ground->cells[0]} * scene.ground->cells[1];
}

}  // namespace

std::string copies_text(std::uint64_t copies) {
  return (copies >= too_many_copies ? "at least " : "") + std::to_string(copies);
}

std::vector<std::uint64_t> placed_copies(const Scene& scene) {
  std::vector<std::uint64_t> copies;
  GroupContents contents(scene);
  for (const auto& entry : scene.plants) copies.push_back(std::min<std::uint64_t>(too_many_copies, entry.placements.size()));
  for (std::uint32_t g = 0; g < scene.groups.size(); ++g)
    if (const auto placed = std::min<std::uint64_t>(too_many_copies >> 1, scene.groups[g].placements.size()); placed > 0)
      for (std::size_t p = 0; p < copies.size(); ++p) copies[p] = std::min(too_many_copies, copies[p] + placed * contents.of(g)[p]);
  return copies;
}

std::vector<std::uint64_t> copies_inside(const Scene& scene, bool is_group, std::uint32_t index) {
  if (is_group) return GroupContents(scene).of(index);
  std::vector<std::uint64_t> copies(scene.plants.size(), 0);
  copies[index] = 1;
  return copies;
}

SceneCounts count(const Scene& scene) {
  SceneCounts counts;
  counts.copies = placed_copies(scene);

  std::unordered_set<const Plant*> seen;
  for (std::size_t p = 0; p < scene.plants.size(); ++p) {
    if (counts.copies[p] == 0) continue;
    const Plant& plant = *scene.plants[p].plant;
    std::unordered_set<std::uint32_t> organs;
    for (const auto& shape : plant.shapes) organs.insert(shape.structure);
    const std::uint64_t facets = plant.facet_count();
    counts.plant_facets += counts.copies[p] * facets;
    counts.organs += counts.copies[p] * organs.size();
    counts.largest_plant_organs = std::max<std::uint64_t>(counts.largest_plant_organs, organs.size());
    counts.leaf_area += static_cast<double>(counts.copies[p]) * plant.area();
    if (seen.insert(&plant).second) counts.unique_facets += facets;
  }
  counts.ground_facets = ground_facets(scene);
  counts.ground_organs = ground_organs(scene);
  counts.organs += counts.ground_organs;
  return counts;
}

std::uint64_t held_bytes(const Scene& scene) {
  std::unordered_set<const Plant*> seen;
  std::uint64_t total = 0;
  for (const auto& entry : scene.plants) {
    total += bytes_of(entry.shape_optics);
    if (seen.insert(entry.plant.get()).second) total += held_bytes(*entry.plant);
  }
  return total;
}

}  // namespace sunfleck
