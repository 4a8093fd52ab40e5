#include "scene/check_reach.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double unknown = -1.0;

class Reach {
 public:
  explicit Reach(const Scene& scene) : scene_(scene), plants_(scene.plants.size(), 0.0), groups_(scene.groups.size(), unknown) {}

  void check() {
    std::map<const Plant*, double> known;
    for (std::size_t p = 0; p < plants_.size(); ++p) {
      const auto& plant = scene_.plants[p].plant;
      const auto [at, fresh] = known.try_emplace(plant.get(), 0.0);
      if (fresh) at->second = own_reach(*plant);
      plants_[p] = at->second;
      limit(plants_[p], [&] { return fmt::format("plant[{}]{}", p, plant->file.empty() ? "" : " of " + plant->file); });
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) of_group(g);
    for (std::size_t p = 0; p < plants_.size(); ++p)
      for (std::size_t i = 0; i < scene_.plants[p].placements.size(); ++i)
        limit(reach_of(scene_.plants[p].placements[i].map, plants_[p]), [&] { return fmt::format("plant[{}].place[{}]", p, i); });
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (std::size_t i = 0; i < scene_.groups[g].placements.size(); ++i)
        limit(reach_of(scene_.groups[g].placements[i].map, groups_[g]),
              [&] { return fmt::format("group[{}] in the world, copy {}", g, i); });
  }

 private:
  static double own_reach(const Plant& plant) {
    std::vector<double> farthest;
    for (const auto& mesh : plant.meshes) farthest.push_back(reach_of(mesh));
    double reach = 0;
    for (const auto& shape : plant.shapes) reach = std::max(reach, reach_of(shape.placement, farthest[shape.mesh]));
    return reach;
  }

  /// Groups hold each other without a circle and no more than a thousand deep.
  double of_group(std::size_t g) {
    if (groups_[g] != unknown) return groups_[g];
    double reach = 0;
    for (std::size_t i = 0; i < scene_.groups[g].members.size(); ++i) {
      const auto& member = scene_.groups[g].members[i];
      const double one = reach_of(member.placement.map, member.is_group ? of_group(member.index) : plants_[member.index]);
      limit(one, [&] { return fmt::format("group[{}].place[{}]", g, i); });
      reach = std::max(reach, one);
    }
    return groups_[g] = reach;
  }

  template <class Key>
  void limit(double reach, Key&& key) const {
    if (!(reach <= farthest_coordinate)) check_reach(scene_, key(), reach);
  }

  const Scene& scene_;
  std::vector<double> plants_, groups_;
};

}  // namespace

double reach_of(const Affine& map, double reach) {
  // no vector grows by more than the square root of the largest row sum of A^T A; by just that in turns, mirrors and scales
  const Mat3 square = glm::transpose(map.linear) * map.linear;
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(square[c].x) + std::abs(square[c].y) + std::abs(square[c].z));
  return glm::length(map.translation) + std::sqrt(largest) * reach;
}

double reach_of(const Mesh& mesh) {
  double reach = 0;
  for (const auto& t : mesh.triangles)
    for (const auto i : t) reach = std::max(reach, glm::length(mesh.vertices[i]));
  return reach;
}

void check_reach(const Scene& scene, const std::string& key, double reach) {
  if (!(reach <= farthest_coordinate))
    throw InputError(location(scene.file, 0, key), fmt::format("parts as far as {:.4g} m from the origin", reach),
                     fmt::format("coordinates from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
}

void check_reach(const Scene& scene) {
  Reach(scene).check();
}

}  // namespace sunfleck
