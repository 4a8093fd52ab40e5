// How much of a triangle lies in each cell of a grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Cells of one size about the nodes of a lattice.
struct NodeGrid {
  Vec3 low{0.0};  ///< corner of the first cell [m]
  std::array<std::int64_t, 3> n{1, 1, 1};
  Vec3 cell{1.0};      ///< [m]; all but a cube: periodic cells are cut into whole ones
  double spacing = 1;  ///< third root of their volume [m]

  std::size_t nodes() const { return static_cast<std::size_t>(n[0] * n[1] * n[2]); }
  std::size_t plane() const { return static_cast<std::size_t>(n[0] * n[1]); }
};

struct CellShare {
  std::uint32_t node;  ///< z n_y n_x + y n_x + x
  float share;         ///< of the triangle's area
};

/// Appends the cells that a triangle touches, with the exact shares of its area. Where `periodic`, cells beyond the border along x and y
/// are those of the other side; else what lies outside of the grid has no cell. `in_lowest_plane`: whatever its height, as for a ground
/// below.
void clip_to_cells(const NodeGrid& grid, const Triangle& triangle, bool periodic, bool in_lowest_plane, std::vector<CellShare>& out);

}  // namespace sunfleck
