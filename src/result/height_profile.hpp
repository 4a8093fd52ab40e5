// Leaf area and absorbed power in layers of height.
#pragma once

#include <cstddef>
#include <vector>

#include <sunfleck/scene/facet_rows.hpp>

namespace sunfleck {

/// Twenty layers of equal depth from the lowest to the highest centroid of the plants' facets; a facet counts where its centroid is.
class HeightProfile {
 public:
  static constexpr std::size_t layers = 20;
  HeightProfile() = default;
  /// Looks at all facets once for the lowest and the highest.
  HeightProfile(const FacetRows& facets, std::size_t states, std::size_t bands);
  std::size_t layer(const Triangle& corners) const;
  void add_area(std::size_t layer, double facet_area) { area[layer] += facet_area; }
  void add_absorbed(std::size_t state, std::size_t layer, std::size_t band, double power) {
    absorbed[(state * layers + layer) * bands_ + band] += power;
  }

  std::vector<double> height;    ///< [layers + 1] edges [m]
  std::vector<double> area;      ///< [layers] one-sided [m^2]
  std::vector<double> absorbed;  ///< [s][layers][b] [W]

 private:
  std::size_t bands_ = 1;
  double low_ = 0, scale_ = 0;
};

}  // namespace sunfleck
