// What light parts of a scene scatter first.
#pragma once

#include <array>
#include <vector>

#include "line_links.hpp"
#include "lit_elements.hpp"

namespace sunfleck {

/// Per part, for each half of the lines: the sky's irradiance, and the fraction of the hemisphere that is not open sky.
struct PartSources {
  std::array<Field, 2> irradiance;         ///< [half] [2 * parts][columns]
  std::array<std::vector<float>, 2> rest;  ///< [half] [2 * parts]
};

/// Fills `area` and `mean_rest` of `light` on the way. Each half has figures of its own, as the product of two from the same lines would be
/// biased; a side that no line of a half meets takes the area means over its cells, which come from both. No direct light reaches enclosed
/// parts.
PartSources part_sources(const LitElements& lit, const LineLinks& links, const std::array<HalfLight, 2>& along, ScatteredLight& light);

/// Light of sun and lamps after reflection and transmission on each cell.
SunReflection sun_reflection(const LitElements& lit);

}  // namespace sunfleck
