#include <sunfleck/scene/plant_sizes.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

namespace sunfleck {

namespace {

constexpr double highest_tree = 120.0, longest_leaf = 2.0;  // [m]

Box mapped(const Box& box, const Affine& map) {
  if (box.empty()) return box;
  const Vec3 middle = map.point(box.centre()), half = 0.5 * box.size();
  Vec3 reach{0.0};
  for (int i = 0; i < 3; ++i) reach += glm::abs(map.linear[i]) * half[i];
  return {middle - reach, middle + reach};
}

/// Boxes of copies of each plant that a group holds, in the group's frame: their union, and the size of the largest.
struct Held {
  Box box;
  Vec3 largest{0.0};

  void add(const Held& other, const Affine& map) {
    const Box all = mapped(other.box, map);
    if (all.empty()) return;
    box.add(all);
    largest = glm::max(largest, mapped(Box{-0.5 * other.largest, 0.5 * other.largest}, map).size());
  }
};
using HeldPlants = std::map<std::uint32_t, Held>;  ///< row of Scene::plants

class Sizes {
 public:
  explicit Sizes(const Scene& scene) : scene_(scene), groups_(scene.groups.size()), known_(scene.groups.size(), false) {}

  SceneSizes find() {
    HeldPlants all;
    for (std::uint32_t p = 0; p < scene_.plants.size(); ++p)
      for (const auto& placement : scene_.plants[p].placements) all[p].add(plant(p), placement.map);
    for (std::uint32_t g = 0; g < scene_.groups.size(); ++g)
      for (const auto& placement : scene_.groups[g].placements)
        for (const auto& [p, held] : group(g)) all[p].add(held, placement.map);
    SceneSizes out;
    out.plants.resize(scene_.plants.size());
    for (const auto& [p, held] : all) {
      if (held.box.empty()) continue;
      out.plants[p] = {held.largest.z, std::max(held.largest.x, held.largest.y), held.box.low.z, held.box.high.z, true};
      out.plants_box.add(held.box);
    }
    out.all = out.plants_box;
    if (scene_.ground) out.all.add(ground_box(*scene_.ground));
    return out;
  }

 private:
  const Held& plant(std::uint32_t p) {
    const auto [at, added] = plants_.try_emplace(scene_.plants[p].plant.get());
    if (added) {
      at->second.box = at->first->bounds();
      at->second.largest = at->second.box.size();
    }
    return at->second;
  }

  const HeldPlants& group(std::uint32_t g) {
    if (!known_[g]) {
      HeldPlants held;
      for (const auto& m : scene_.groups[g].members) {
        if (!m.is_group)
          held[m.index].add(plant(m.index), m.placement.map);
        else
          for (const auto& [p, inner] : group(m.index)) held[p].add(inner, m.placement.map);
      }
      groups_[g] = std::move(held);
      known_[g] = true;
    }
    return groups_[g];
  }

  static Box ground_box(const Ground& ground) {
    Box box;
    if (ground.mesh) {
      for (const auto& v : ground.mesh->vertices) box.add(v);
      return box;
    }
    const Vec3 middle{ground.centre[0], ground.centre[1], ground.height}, half{0.5 * ground.size[0], 0.5 * ground.size[1], 0.0};
    return {middle - half, middle + half};
  }

  const Scene& scene_;
  std::unordered_map<const Plant*, Held> plants_;
  std::vector<HeldPlants> groups_;
  std::vector<bool> known_;
};

bool is_called_leaf(std::string type) {
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type == "leaf" || type == "leaflet" || type == "blade" || type == "needle";
}

/// Mean length of leaves, as the diagonal of what belongs to one [m]; 0 without any. Plants of one structure alone tell nothing.
double mean_leaf(const Plant& plant) {
  if (plant.structures.size() < 2) return 0.0;
  std::vector<Box> boxes(plant.structures.size());
  for (const auto& shape : plant.shapes) {
    if (!is_called_leaf(plant.types[plant.structures[shape.structure].type])) continue;
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t)
      for (const auto& corner : shape_triangle(plant, shape, t)) boxes[shape.structure].add(corner);
  }
  double sum = 0.0, count = 0.0;
  for (const auto& box : boxes)
    if (!box.empty()) sum += glm::length(box.size()), count += 1.0;
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

SceneSizes scene_sizes(const Scene& scene) {
  return Sizes(scene).find();
}

std::vector<std::string> notes_on_sizes(const Scene& scene, const SceneSizes& sizes) {
  std::vector<std::string> notes;
  std::unordered_map<const Plant*, double> leaves;
  for (std::size_t p = 0; p < scene.plants.size(); ++p) {
    const auto& entry = scene.plants[p];
    const auto& size = sizes.plants[p];
    if (!size.placed) continue;
    if (size.height > highest_tree)
      notes.push_back(fmt::format("plant \"{}\" is {:.4g} m high: is its `unit` right?", entry.name, size.height));
    const auto [leaf, added] = leaves.try_emplace(entry.plant.get(), 0.0);
    if (added) leaf->second = mean_leaf(*entry.plant);
    const Vec3 own = entry.plant->bounds().size();
    const double scale = own.z > 0.0 ? size.height / own.z : 1.0;
    if (scale * leaf->second > longest_leaf)
      notes.push_back(
          fmt::format("plant \"{}\" has leaves of {:.3g} m on average: is its `unit` right?", entry.name, scale * leaf->second));
    if (scene.ground && !scene.ground->mesh && size.highest < scene.ground->height - 1e-6 * (1.0 + size.height))
      notes.push_back(fmt::format("plant \"{}\" lies below the ground: its highest point is at {:.4g} m, the ground at {:.4g} m",
                                  entry.name, size.highest, scene.ground->height));
  }
  return notes;
}

}  // namespace sunfleck
