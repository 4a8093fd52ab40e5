// Polygons of files as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// A face that names vertices before they come: its triangles have their places already.
struct LateFace {
  long line;
  std::size_t first_triangle;
  std::vector<std::uint32_t> corners;
};

/// Cuts polygons of n corners into n - 2 triangles with the polygon's front: as a fan from the first corner where that covers it (any
/// convex polygon, and those that the first corner sees all of), else by clipping ears (Meisters 1975, doi:10.1080/00029890.1975.11993898)
/// in the polygon's mean plane (Newell's normal), where a corner on the way of a cut is no ear. The same polygon is always cut alike. Holes
/// joined to the outline by a pair of edges are polygons too. One that crosses itself is cut as far as it goes, and counted; so is one that
/// is far from flat, whose area depends on the cut.
class PolygonCutter {
 public:
  /// Corners are three or more indices of vertices. Valid until the next call. InputError for a polygon too intricate to be cut in
  /// reasonable time, with the line if it is above 0.
  const std::vector<std::array<std::uint32_t, 3>>& cut(const std::vector<Vec3>& vertices, std::span<const std::uint32_t> corners,
                                                       const std::string& file, long line = 0);
  /// What its user should know of the polygons cut, if anything: a line each.
  void note(const std::string& file, std::vector<std::string>& notes) const;

 private:
  bool project(const std::vector<Vec3>& vertices, std::span<const std::uint32_t> corners);
  bool fan_covers() const;

  std::vector<glm::dvec2> points_;  ///< corners in the mean plane, about the first, in units of the polygon's size
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::size_t crossing_ = 0, warped_ = 0;
};

}  // namespace sunfleck
