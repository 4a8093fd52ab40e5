#include <sunfleck/visibility/surface.hpp>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/visibility/ground_gap.hpp>

namespace sunfleck {

std::size_t Surface::bytes() const {
  std::size_t total = bytes_of(first_cell) + bytes_of(split) + bytes_of(cell_area);
  for (const auto& c : corner) total += bytes_of(c);
  for (const auto& c : normal) total += bytes_of(c);
  return total;
}

double Surface::longest_way(const Vec3& direction) const {
  if (focus.empty()) return 0.0;
  const Vec3 size = focus.size();
  double way = glm::length(size) + (periodic ? size.z * 1e6 : 0.0);  // a level ray through a periodic scene has no end
  for (int axis = periodic ? 2 : 0; axis < 3; ++axis)
    if (const double gain = axis == 2 && periodic ? periodic->above(direction) : direction[axis]; gain != 0.0)
      way = std::min(way, size[axis] / std::fabs(gain));
  return way;
}

Surface make_surface(const FacetScene& scene, const std::vector<std::uint32_t>& order, const std::vector<std::uint16_t>& split,
                     const RowPieces& pieces, bool ground_is_flat) {
  Surface s;
  const std::size_t n = order.size();
  const Box plants = plant_bounds(scene);
  const Box& precise = plants.empty() ? scene.bounds : plants;  // what single precision serves best
  const GroundGap gap(scene);
  const Box& middle = scene.periodic ? scene.bounds : precise;  // lines of a cell are laid out from there
  s.origin = middle.empty() ? Vec3{0.0} : middle.centre();
  s.periodic = scene.periodic;
  s.ground_gap = gap.metres();
  for (auto& c : s.corner) c.resize(n);
  for (auto& c : s.normal) c.resize(n);
  s.split.resize(n);
  s.cell_area.resize(n);
  s.first_cell.assign(n + 1, 0);
  s.focus_count = n;
  if (ground_is_flat && !plants.empty())
    while (s.focus_count > 0 && order[s.focus_count - 1] >= scene.plant_facets) --s.focus_count;
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
    const Triangle& given = pieces.corners_of(i, scene.corners[order[i]]);
    const Triangle t = order[i] < scene.plant_facets ? given : gap.lowered(given);
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) s.corner[3 * k + axis][i] = static_cast<float>(t[k][axis] - s.origin[axis]);
    const Vec3 a = area_vector(t);
    const double area = glm::length(a);
    const bool real = scene.area[order[i]] > 0.0f;
    for (int axis = 0; axis < 3; ++axis) s.normal[axis][i] = real ? static_cast<float>(a[axis] / area) : 0.0f;
    s.split[i] = real ? split[i] : std::uint16_t{0};
    const auto k = static_cast<float>(std::max<int>(1, split[i]));
    s.cell_area[i] = static_cast<float>(area) / (k * k);
  });
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t k = std::max<std::uint32_t>(1, s.split[i]);
    s.first_cell[i + 1] = s.first_cell[i] + k * k;
    if (i < s.focus_count && s.split[i] > 0)
      for (const auto& p : scene.corners[order[i]]) s.focus.add(p - s.origin);
  }
  const Vec3 size = precise.size();
  s.depth_tolerance = 1e-6 * std::max({size.x, size.y, size.z});
  return s;
}

}  // namespace sunfleck
