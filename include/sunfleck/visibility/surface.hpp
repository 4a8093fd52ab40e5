// Triangles prepared for parallel projection: single precision about a local origin, structure of arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// What is projected. A triangle is split into `split^2` congruent *cells*, numbered from `first_cell`; cells are the finest
/// pieces whose light is told apart. Coordinates are relative to `origin` [m].
struct Surface {
  Vec3 origin{0.0};
  std::array<std::vector<float>, 9> corner;  ///< x0 y0 z0 x1 y1 z1 x2 y2 z2, each [n]
  std::array<std::vector<float>, 3> normal;  ///< unit front normal, each [n]; zero where the area is zero
  std::vector<std::uint32_t> first_cell;     ///< [n + 1]
  std::vector<std::uint16_t> split;          ///< [n] >= 1; 0 = never projected (zero area), still one cell
  std::vector<float> cell_area;              ///< [n] one-sided area of one cell of the triangle [m^2]
  std::size_t focus_count = 0;               ///< triangles [0, focus_count) span the focus box; the others (flat ground) may lie outside
  Box focus;                                 ///< relative to origin: lines are drawn through this box only
  double depth_tolerance = 0.0;              ///< fragments closer than this along a line coincide [m]
  double ground_gap = 0.0;                   ///< the ground's corners are this much lower than it is given [m], see GroundGap
  std::optional<PeriodicCell> periodic;      ///< in world coordinates

  std::size_t size() const { return split.size(); }
  std::size_t cells() const { return first_cell.back(); }
  std::size_t bytes() const;
  /// Length of the longest way that a straight line can go through the focus box; the horizontal bounds of periodic scenes are open.
  double longest_way(const Vec3& direction) const;
};

/// Number of the cell that holds barycentric (u, v) in a triangle split k times: rows of constant v, each from low to high u.
inline std::uint32_t cell_of(float u, float v, int k) {  // without branches, so that loops over it become vector code
  const float a = u * static_cast<float>(k), b = v * static_cast<float>(k);
  const int j = std::min(std::max(static_cast<int>(b), 0), k - 1);
  const int i = std::min(std::max(static_cast<int>(a), 0), k - 1 - j);
  const int upper = static_cast<int>((a - static_cast<float>(i)) + (b - static_cast<float>(j)) > 1.0f) & static_cast<int>(i + j < k - 1);
  return static_cast<std::uint32_t>(j * (2 * k - j) + 2 * i + upper);
}

/// Rows that are pieces of a facet, where some are.
struct RowPieces {
  static constexpr std::uint32_t whole = 0xffffffffu;
  std::vector<std::uint32_t> of_row;  ///< [rows] row of `corners`, or whole; empty: all are
  std::vector<Triangle> corners;      ///< world [m]

  const Triangle& corners_of(std::size_t row, const Triangle& facet) const {
    return of_row.empty() || of_row[row] == whole ? facet : corners[of_row[row]];
  }
};

/// Prepares facets of a scene in the order given. `split[i]` belongs to row i, which is facet `order[i]` or a piece of it; facets of the
/// ground must come last when `ground_is_flat`, and are then left out of the focus if any plant has an area. Zero-area facets get split 0.
Surface make_surface(const FacetScene& scene, const std::vector<std::uint32_t>& order, const std::vector<std::uint16_t>& split,
                     const RowPieces& pieces, bool ground_is_flat);

}  // namespace sunfleck
