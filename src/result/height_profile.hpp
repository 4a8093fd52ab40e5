// Leaf area and absorbed power in layers of height.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Twenty layers of equal depth from the lowest to the highest centroid of the plants' facets; a facet counts where its centroid is.
class HeightProfile {
 public:
  static constexpr std::size_t layers = 20;
  HeightProfile() = default;
  HeightProfile(const FacetScene& facets, std::size_t states);
  void add_absorbed(std::size_t state, std::size_t facet, std::size_t band, double power) {
    absorbed[(state * layers + layer_[facet]) * bands_ + band] += power;
  }

  std::vector<double> height;    ///< [layers + 1] edges [m]
  std::vector<double> area;      ///< [layers] one-sided [m^2]
  std::vector<double> absorbed;  ///< [s][layers][b] [W]

 private:
  std::size_t bands_ = 1;
  std::vector<std::uint8_t> layer_;  ///< [plant facets]
};

}  // namespace sunfleck
