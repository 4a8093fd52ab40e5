#include "view/outline.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

namespace sunfleck {

namespace {

constexpr std::size_t outline_directions = 256;

std::vector<Vec3> axes() {
  std::vector<Vec3> out{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; out.size() < outline_directions; ++i) {  // Fibonacci's sphere
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(outline_directions - 6), r = std::sqrt(1 - z * z);
    out.push_back({r * std::cos(turn * static_cast<double>(i)), r * std::sin(turn * static_cast<double>(i)), z});
  }
  return out;
}

std::vector<Vec3> farthest(const std::vector<Vec3>& points) {
  if (points.size() <= outline_directions) return points;
  const auto all = axes();
  std::vector<std::size_t> best(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (const double d = glm::dot(points[i], all[k]); d > most) most = d, best[k] = i;
  });
  std::vector<Vec3> out;
  std::vector<std::size_t> taken;
  for (const auto i : best)
    if (std::find(taken.begin(), taken.end(), i) == taken.end()) taken.push_back(i), out.push_back(points[i]);
  return out;
}

/// Vertices of a run of triangles with area, each once.
void collect(const Mesh& mesh, std::size_t first, std::size_t count, std::vector<std::uint32_t>& rows) {
  rows.clear();
  for (std::size_t t = first; t < first + count; ++t)
    if (glm::length(area_vector(mesh.corners(t))) > 0) rows.insert(rows.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

}  // namespace

std::vector<Vec3> outline_points(const Plant& plant) {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> rows;
  constexpr std::size_t most = std::size_t{1} << 21;  // then only the farthest so far are kept
  for (const auto& shape : plant.shapes) {
    const Mesh& mesh = plant.meshes[shape.mesh];
    collect(mesh, shape.first_triangle, shape.triangle_count, rows);
    for (const auto r : rows) points.push_back(shape.placement.point(mesh.vertices[r]));
    if (points.size() > most) points = farthest(points);
  }
  return farthest(points);
}

std::vector<Vec3> outline_points(const Mesh& mesh) {
  std::vector<std::uint32_t> rows;
  collect(mesh, 0, mesh.triangles.size(), rows);
  std::vector<Vec3> points;
  for (const auto r : rows) points.push_back(mesh.vertices[r]);
  return farthest(points);
}

}  // namespace sunfleck
