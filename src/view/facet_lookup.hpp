// What maps ask of a scene, the same for scenes in memory and scenes that are not written out.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <sunfleck/view/drawn_scene.hpp>

namespace sunfleck {

/// Columns over ranges of facets [first, first + count).
struct FacetLookup {
  template <class T>
  using Column = std::function<std::vector<T>(std::size_t first, std::size_t count)>;
  std::size_t size = 0, plant_facets = 0;
  Column<std::uint32_t> organ, optics, level;
  Column<float> area;    ///< [m^2]
  Column<float> height;  ///< of the middle above z = 0 [m]
};

/// The scene must outlive the answer. The scene in memory takes the level of a facet from the result.
FacetLookup lookup(const DrawnScene& scene);
FacetLookup lookup(const FacetScene& scene, const Result& result);

}  // namespace sunfleck
