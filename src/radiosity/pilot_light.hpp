// Light that comes evenly from all round, found by a few lines: how bright the cells of a surface are beside each other.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Optics in the band that scatters most.
struct Brightest {
  float front = 0, back = 0, through = 0;
  explicit Brightest(const Optics& m) {
    for (std::size_t b = 0; b < m.transmittance.size(); ++b)
      if (m.reflectance_front[b] + m.reflectance_back[b] + 2 * m.transmittance[b] > front + back + 2 * through) {
        front = m.reflectance_front[b];
        back = m.reflectance_back[b];
        through = m.transmittance[b];
      }
  }
};

/// What lines bring to each side of each cell, 2 * cell + (0 front, 1 back), of a radiance of 1 from all round, in the band in which the
/// cell's material scatters most: irradiance is sum / lines, relative to that in the open.
struct PilotLight {
  std::vector<float> lines, sum, squares;  ///< [2 * cells] number, sum and sum of squares over the lines
  std::vector<float> open;                 ///< [2 * cells] lines that meet nothing else: what of `sum` comes straight
};

/// So many reflections are followed from cell to cell, over lines of so many directions that are `pitch` apart [m].
PilotLight pilot_light(const FacetScene& facets, const Elements& elements, std::uint32_t directions, double pitch, int reflections);

}  // namespace sunfleck
