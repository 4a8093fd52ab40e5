#include "result/height_profile.hpp"

#include <algorithm>

namespace sunfleck {

namespace {

double centroid_height(const Triangle& t) {
  return (t[0].z + t[1].z + t[2].z) / 3.0;
}

}  // namespace

HeightProfile::HeightProfile(const FacetScene& facets, std::size_t states)
    : area(layers, 0.0), absorbed(states * layers * facets.bands, 0.0), bands_(facets.bands), layer_(facets.plant_facets) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t f = 0; f < facets.plant_facets; ++f) {
    const double z = centroid_height(facets.corners[f]);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  if (facets.plant_facets == 0) low = high = 0.0;
  for (std::size_t i = 0; i <= layers; ++i) height.push_back(low + (high - low) * static_cast<double>(i) / layers);
  const double scale = high > low ? layers / (high - low) : 0.0;
  for (std::size_t f = 0; f < facets.plant_facets; ++f) {
    const double position = (centroid_height(facets.corners[f]) - low) * scale;
    layer_[f] = static_cast<std::uint8_t>(std::clamp(position, 0.0, layers - 1.0));
    area[layer_[f]] += facets.area[f];
  }
}

}  // namespace sunfleck
