// Shades of the plants of a scene, each found once for all its copies.
#pragma once

#include <cstdint>
#include <vector>

#include "gather_elements.hpp"
#include "shades.hpp"

namespace sunfleck {

struct PlantShades {
  std::vector<Shades> found;
  std::vector<std::uint32_t> of_copy;      ///< [copies] row of `found`, or none
  std::vector<std::uint32_t> first_facet;  ///< [copies + 1] of the scene; copies follow each other
  static constexpr std::uint32_t none = 0xffffffffu;
};

/// Each plant alone, as its first copy stands: neighbours and the ground have no part in it.
PlantShades plant_shades(const Scene& scene, const FacetScene& facets, const Patches& patches, const RadiositySettings& settings,
                         const ElementSizes& sizes);

/// Cells along an edge of each facet, 0 where shades say nothing; empty if there are no shades.
std::vector<std::uint16_t> splits(const PlantShades& shades, std::size_t facets);

/// Cells of one element that are of different shades become elements of their own; `weighed`: with Elements::emission.
void part_elements(const FacetScene& facets, const PlantShades& shades, bool weighed, Elements& elements);

}  // namespace sunfleck
