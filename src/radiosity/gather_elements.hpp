// Facets become cells, and cells are gathered into elements by patch.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

struct ElementSizes {
  double patch = 0;    ///< mean area of plants' patches [m^2]
  double element = 0;  ///< area aimed at [m^2]
};

/// `split`: [facets] cells along an edge; 0, or empty = as the sizes say. `flat`: one element a facet.
Elements gather_elements(const Scene& scene, const FacetScene& facets, const Patches& patches, bool flat, const ElementSizes& sizes,
                         const std::vector<std::uint16_t>& split);

/// Lists the cells of each element, as element_of_cell has them.
void list_cells(Elements& elements);

}  // namespace sunfleck
