#include "lattice/stand_grid.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

NodeGrid grid_over(const Box& box, std::uint32_t nodes) {
  NodeGrid grid;
  const Vec3 size = box.size();
  grid.spacing = std::max({size.x, size.y, size.z, 1e-9}) / nodes;
  grid.cell = Vec3{grid.spacing};
  for (int axis = 0; axis < 3; ++axis) {
    grid.n[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(size[axis] / grid.spacing - 1e-6)));
    grid.low[axis] = box.low[axis] - 0.5 * (static_cast<double>(grid.n[axis]) * grid.spacing - size[axis]);
  }
  return grid;
}

bool has_flat_ground(const Scene& scene) {
  return scene.ground && !scene.ground->mesh;
}

NodeGrid stand_grid(const Scene& scene, const FacetScene& facets, std::uint32_t nodes) {
  Box box;
  const bool flat = has_flat_ground(scene);
  const std::size_t end = flat ? facets.plant_facets : facets.size();
  for (std::size_t f = 0; f < end; ++f)
    if (facets.area[f] > 0.0f)
      for (const auto& p : facets.corners[f]) box.add(p);
  if (box.empty()) box = facets.bounds;
  if (flat) {
    const auto& ground = *scene.ground;
    box.low.z = std::min(box.low.z, ground.height);
    const double beside = box.high.z - box.low.z;
    for (int axis = 0; axis < 2 && !scene.periodic; ++axis) {
      const double low = ground.centre[axis] - 0.5 * ground.size[axis], high = ground.centre[axis] + 0.5 * ground.size[axis];
      box.low[axis] = std::min(box.low[axis], std::max(low, box.low[axis] - beside));
      box.high[axis] = std::max(box.high[axis], std::min(high, box.high[axis] + beside));
    }
  }
  if (scene.periodic) {
    box.low.x = scene.periodic->x_low, box.low.y = scene.periodic->y_low;
    box.high.x = scene.periodic->x_high, box.high.y = scene.periodic->y_high;
  }
  NodeGrid grid = grid_over(box, nodes);
  const Vec3 size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 2 ? !flat : !scene.periodic) continue;
    grid.n[axis] = std::max<std::int64_t>(1, std::llround(size[axis] / grid.spacing));
    grid.cell[axis] = std::max(size[axis] / static_cast<double>(grid.n[axis]), 1e-9);
    grid.low[axis] = box.low[axis];
  }
  grid.spacing = std::cbrt(grid.cell.x * grid.cell.y * grid.cell.z);
  return grid;
}

}  // namespace sunfleck
