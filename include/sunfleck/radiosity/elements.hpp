// Elements: the pieces of the scene that each have one scattered irradiance per side.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/solve.hpp>
#include <sunfleck/visibility/surface.hpp>

#include <sunfleck/radiosity/cluster_order.hpp>

namespace sunfleck {

/// Facets in the order of the cluster tree, cut into cells (large facets) and gathered into elements (small facets of one organ and
/// one material; organs smaller than half an element share one with neighbours).
struct Elements {
  std::vector<std::uint32_t> order;  ///< [n] facet of each row of the surface
  ClusterOrder tree;                 ///< of organs
  Surface surface;
  std::vector<std::uint32_t> element_of_cell;  ///< [cells]
  std::vector<std::uint32_t> organ_of_row;     ///< [n] row of FacetScene::organs
  std::vector<std::uint32_t> row_of_cell;      ///< [cells] row of the surface
  std::vector<std::uint32_t> first_cell;       ///< [elements + 1] into `cells`
  std::vector<std::uint32_t> cells;            ///< cells of each element
  std::vector<float> area;                     ///< [elements] one-sided [m^2]
  std::vector<std::uint32_t> material;         ///< [elements] row of FacetScene::materials
  double organ_area = 0;                       ///< mean area of plant organs [m^2], the scale of all densities
  double element_area = 0;                     ///< area aimed at [m^2]

  std::size_t size() const { return area.size(); }
  std::size_t bytes() const;
};

/// Method flat: one element a facet. Else facets of an organ are gathered, and large facets cut, to about the aimed element area; flat
/// ground is cut only near plants. Nothing here depends on the light.
Elements make_elements(const Scene& scene, const FacetScene& facets, const RadiositySettings& settings);

}  // namespace sunfleck
