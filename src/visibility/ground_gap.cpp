#include <sunfleck/visibility/ground_gap.hpp>

#include <algorithm>

namespace sunfleck {

namespace {

constexpr double of_plants = 2.5e-6, of_all = 1e-6;

double longest(const Box& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

}  // namespace

GroundGap::GroundGap(const Box& plants, const Box& all)
    : metres_(plants.empty() ? 0.0 : std::max(of_plants * longest(plants), of_all * longest(all))) {}

GroundGap::GroundGap(const FacetScene& scene) {
  if (scene.plant_facets == scene.size()) return;
  const Box plants = plant_bounds(scene);
  *this = GroundGap(plants, ground_is_level(scene) ? plants : scene.bounds);
}

bool ground_is_level(const FacetScene& scene) {
  for (std::size_t f = scene.plant_facets; f < scene.size(); ++f)
    for (const auto& p : scene.corners[f])
      if (p.z != scene.corners[scene.plant_facets][0].z) return false;
  return true;
}

Box plant_bounds(const FacetScene& scene) {
  Box box;
  for (std::size_t f = 0; f < scene.plant_facets; ++f)
    if (scene.area[f] > 0.0f)
      for (const auto& p : scene.corners[f]) box.add(p);
  return box;
}

}  // namespace sunfleck
