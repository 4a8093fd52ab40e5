#include <sunfleck/scene/slope.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

namespace {

/// The facets of flat ground, leant.
Mesh leaning(const Ground& ground, const PeriodicCell& cell) {
  const double x0 = ground.centre[0] - 0.5 * ground.size[0], y0 = ground.centre[1] - 0.5 * ground.size[1];
  const GroundFacets facets({x0, y0, x0 + ground.size[0], y0 + ground.size[1]}, ground.cells, ground.height);
  Mesh mesh;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (Vec3 p : facets[f]) {
      p.z += cell.slope_x * p.x + cell.slope_y * p.y;
      mesh.vertices.push_back(p);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace

bool lies_on_slope(const Scene& scene) {
  return scene.periodic && !scene.periodic->is_level();
}

Vec3 lifted(const PeriodicCell& cell, const Vec3& d, double least) {
  const double gain = cell.above(d);
  if (!(gain < least)) return d;
  return glm::normalize(Vec3{d.x, d.y, d.z + (least - gain)});
}

std::vector<std::string> lay_on_slope(Scene& scene) {
  std::vector<std::string> notes;
  if (!lies_on_slope(scene)) return notes;
  const auto& cell = *scene.periodic;
  if (scene.ground && !scene.ground->mesh) scene.ground->mesh = leaning(*scene.ground, cell);
  for (auto& state : scene.states) {
    if (state.sky) state.sky->horizon = glm::normalize(Vec3{-cell.slope_x, -cell.slope_y, 1.0});
    if (state.sun && !(cell.above(state.sun->direction) > 0.0)) {
      state.sun.reset();
      notes.push_back(
          fmt::format("{}: the sun stands behind the slope: no sun", state.name.empty() ? "sun" : "sun of state \"" + state.name + '"'));
    }
  }
  return notes;
}

}  // namespace sunfleck
