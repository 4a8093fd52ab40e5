// Light on facets, as rows of the result.
#pragma once

#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/solution.hpp>

#include "lit_elements.hpp"

namespace sunfleck {

/// E = direct + (fraction that is not open sky) x gathered, averaged over each facet's cells: writes the rows of all facets in their order,
/// and adds what they meet directly and absorb to `balance` [s][b]. `row_of_facet`: row of the surface of each facet.
void write_light_rows(const LitElements& lit, const ScatteredLight& scattered, const std::vector<std::uint32_t>& row_of_facet,
                      IrradianceSink& sink, std::vector<std::vector<Balance>>& balance, Progress& progress);

}  // namespace sunfleck
