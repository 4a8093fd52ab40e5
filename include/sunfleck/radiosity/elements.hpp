// Elements: the pieces of the scene that each have one scattered irradiance per side.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/visibility/ground_pieces.hpp>
#include <sunfleck/visibility/surface.hpp>

#include <sunfleck/radiosity/cluster_order.hpp>

namespace sunfleck {

/// Facets in the order of the cluster tree, cut into cells (large facets) and gathered into elements (small facets of one patch;
/// patches smaller than half an element share one with neighbours of their material).
struct Elements {
  std::vector<std::uint32_t> order;  ///< [rows] facet of each row of the surface; several rows, one after the other, if it is cut in pieces
  RowPieces pieces;                  ///< of facets of the ground
  GroundPieceIndex piece_index;      ///< rows of the pieces
  std::size_t plant_facets = 0;      ///< facets from here on are of the ground
  ClusterOrder tree;                 ///< of patches
  Surface surface;
  std::vector<std::uint32_t> element_of_cell;  ///< [cells]
  std::vector<std::uint32_t> patch_of_row;     ///< [rows] row of Patches
  std::vector<std::uint32_t> row_of_cell;      ///< [cells] row of the surface
  std::vector<std::uint32_t> first_cell;       ///< [elements + 1] into `cells`
  std::vector<std::uint32_t> cells;            ///< cells of each element
  std::vector<float> area;                     ///< [elements] one-sided [m^2]
  std::vector<std::uint32_t> material;         ///< [elements] row of FacetScene::materials
  /// [2 * cells] (front, back) how much a cell sends out beside the mean of its element, 32 = as much; empty = all do. Where light falls
  /// off within an element, what sees its dark end gets less.
  std::vector<std::uint8_t> emission;
  double patch_area = 0;    ///< mean area of plants' patches [m^2], the scale of all densities
  double element_area = 0;  ///< area aimed at [m^2]

  std::size_t size() const { return area.size(); }
  /// The row and cell of a point of a facet, whose first row is given; u, v as in RayHit.
  struct Place {
    std::uint32_t row, cell;
  };
  Place place_of(std::uint32_t first_row, double u, double v) const;
  /// Calls f(cell, its share of the facet's area) for the cells of a facet, whose first row is given.
  template <class F>
  void for_cells_of_facet(std::size_t first_row, const F& f) const {
    const auto& s = surface;
    std::size_t end = first_row + 1;
    while (!pieces.of_row.empty() && end < order.size() && order[end] == order[first_row]) ++end;
    double whole = 0.0;
    if (end > first_row + 1)
      for (std::size_t t = first_row; t < end; ++t) whole += static_cast<double>(s.cell_area[t]) * (s.first_cell[t + 1] - s.first_cell[t]);
    for (std::size_t t = first_row; t < end; ++t) {
      const std::uint32_t begin = s.first_cell[t], last = s.first_cell[t + 1];
      const float share =
          end == first_row + 1 ? 1.0f / static_cast<float>(last - begin) : static_cast<float>(static_cast<double>(s.cell_area[t]) / whole);
      for (std::uint32_t c = begin; c < last; ++c) f(c, share);
    }
  }

  std::size_t bytes() const;
};

/// Method flat: one element a facet. Else facets of a patch are gathered, and large facets cut, to about the aimed element area, which is
/// smaller where patches are wider than the periodic cell; flat ground is cut only near plants. Facets of the ground too wide for that, and
/// plants' facets wider than a fourth of a periodic cell, are cut with method flat too. Nothing here depends on the light.
Elements make_elements(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings);

}  // namespace sunfleck
