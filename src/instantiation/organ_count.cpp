#include "instantiation/organ_count.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sunfleck/scene/patches.hpp>
#include <sunfleck/visibility/surface.hpp>

namespace sunfleck {

namespace {

constexpr double enough_organs = 200;
constexpr std::size_t few_members = 8;
constexpr double few_organs = 20;
constexpr double worth_cutting = 1.5;  // times finer
constexpr double most_uneven = 4.0;

struct Size {
  double area = 0, patches = 0;
};

Size size_of(const PlantEntry& entry) {
  const Plant& plant = *entry.plant;
  std::vector<Triangle> corners;
  std::vector<std::uint32_t> optics;
  for (std::size_t s = 0; s < plant.shapes.size(); ++s)
    for (std::uint32_t t = 0; t < plant.shapes[s].triangle_count; ++t) {
      corners.push_back(shape_triangle(plant, plant.shapes[s], t));
      optics.push_back(entry.shape_optics[s]);
    }
  const auto patch = patches_of_plant(corners, optics);
  std::vector<double> areas(corners.size(), 0.0);
  for (std::size_t f = 0; f < corners.size(); ++f) areas[patch[f]] += glm::length(area_vector(corners[f]));
  const auto all = patch_areas(std::move(areas));
  return {all.sum, all.count};
}

}  // namespace

std::vector<double> fewest_organs(const Scene& scene, const Originals& originals) {
  std::vector<Size> plants;
  for (const auto& entry : scene.plants) plants.push_back(size_of(entry));
  std::vector<Size> size(originals.originals.size());  // at scale 1
  for (std::size_t o = 0; o < size.size(); ++o)
    for (const auto& part : originals.originals[o].parts) {
      if (part.plant >= plants.size()) continue;
      size[o].area += plants[part.plant].area * std::pow(std::fabs(glm::determinant(part.map.linear)), 2.0 / 3.0);
      size[o].patches += plants[part.plant].patches;
    }
  Size all;
  std::vector<std::size_t> members(size.size(), 0);
  std::vector<double> square(size.size(), 0.0);  // of the largest member's scale
  for (std::size_t m = 0; m < originals.solved; ++m) {
    const auto& member = originals.members[m];
    const double scale = member.map.scale * member.map.scale;
    all.area += scale * size[member.original].area;
    all.patches += size[member.original].patches;
    ++members[member.original];
    square[member.original] = std::max(square[member.original], scale);
  }
  std::vector<double> out(size.size(), 1.0);
  for (std::size_t o = 0; o < out.size(); ++o) {
    if (originals.originals[o].parts.front().plant >= plants.size()) out[o] = 0;
    if (!(size[o].patches > 0) || !(all.area > 0)) continue;
    const double alike = square[o] * size[o].area * all.patches / all.area;  // organs of the scene's mean size
    const bool apart = size[o].patches <= few_organs && members[o] <= few_members;
    const double wanted = apart ? enough_organs : std::min(enough_organs, alike);
    if (wanted >= worth_cutting * size[o].patches) out[o] = wanted;
  }
  return out;
}

double times_finer(const FacetScene& facets, double fewest_organs) {
  if (!(fewest_organs > 0)) return 1.0;
  const Patches patches = find_patches(facets);
  std::vector<double> area(patches.size(), 0.0);
  for (std::size_t f = 0; f < facets.size(); ++f) area[patches.of_facet[f]] += facets.area[f];
  std::erase(area, 0.0);
  if (area.size() < 2) return std::max(1.0, fewest_organs);
  std::sort(area.begin(), area.end());
  const std::size_t kept = area.size() - 1 - (area.size() - 1) / 100;
  const auto mean = [&](std::size_t n) {
    const auto all = patch_areas({area.begin(), area.begin() + static_cast<std::ptrdiff_t>(n)});
    return all.sum / all.count;
  };
  const double uneven = std::min(mean(area.size()) / mean(kept), most_uneven);
  return std::max(
      {1.0, fewest_organs * mean(area.size()) / std::accumulate(area.begin(), area.end(), 0.0), uneven >= worth_cutting ? uneven : 1.0});
}

}  // namespace sunfleck
