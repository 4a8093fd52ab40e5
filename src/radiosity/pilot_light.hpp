// Light that comes evenly from all round, found by a few lines: how bright the cells of a surface are beside each other.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// What lines bring to each side of each cell, 2 * cell + (0 front, 1 back), of a radiance of 1 from all round, in the band in which the
/// cell's material scatters most: irradiance is sum / lines, relative to that in the open.
struct PilotLight {
  std::vector<float> lines, sum, squares;  ///< [2 * cells] number, sum and sum of squares over the lines
};

/// So many reflections are followed from cell to cell, over lines of so many directions that are `pitch` apart [m].
PilotLight pilot_light(const FacetScene& facets, const Elements& elements, std::uint32_t directions, double pitch, int reflections);

}  // namespace sunfleck
