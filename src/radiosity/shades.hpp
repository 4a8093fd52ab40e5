// Where light falls off within an element: parts of a plant's surface that are about equally bright.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Cells of a plant by how bright they are. Cells of one element that are of different shades become elements of their own.
struct Shades {
  std::vector<std::uint16_t> split;       ///< [facets of the plant] cells along an edge; 0 = as elsewhere: they are all of one shade
  std::vector<std::uint32_t> first_cell;  ///< [facets + 1] into `of_cell`; one for each facet that is not cut
  std::vector<std::uint16_t> of_cell;     ///< number of the shade within its element, from the darkest to the brightest

  std::vector<float> emission;  ///< [2 * of_cell] (front, back) exitance in light from all round, relative to a source in the open

  bool empty() const { return of_cell.empty(); }
  std::uint16_t at(std::size_t facet, std::uint32_t cell) const { return of_cell[place(facet, cell)]; }
  float emission_at(std::size_t facet, std::uint32_t cell, std::size_t side) const { return emission[2 * place(facet, cell) + side]; }

 private:
  std::size_t place(std::size_t facet, std::uint32_t cell) const { return first_cell[facet] + (split[facet] == 0 ? 0 : cell); }
};

/// Variance within elements of the light on both sides that shades would tell apart, relative to light in the open, mean over the area:
/// whether it is worth finding them. Arguments as below.
double unevenness(const FacetScene& facets, const Elements& elements, std::uint32_t directions, double pitch);

/// Cuts the elements of a plant, which is all that `facets` hold, where its lines find that light falls off within them: by the plane
/// across an element's extent that separates best what is bright from what is dark, again and again, as long as it tells more than the
/// lines' noise and is worth an element. Light is that of an even sphere, so that shades do not depend on the scene's.
/// `elements`: of the plant alone, cut into fine cells.
Shades find_shades(const FacetScene& facets, const Elements& elements, std::uint32_t directions, double pitch);

}  // namespace sunfleck
