#include "result/height_profile.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <limits>

namespace sunfleck {

namespace {

double centroid_height(const Triangle& t) {
  return (t[0].z + t[1].z + t[2].z) / 3.0;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double z) {
    low = std::min(low, z);
    high = std::max(high, z);
  }
};

Range heights(const FacetRows& facets) {
  const std::uint64_t n = facets.placed().first_ground_facet;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::uint64_t>(0, n, 16384), Range{},
      [&](const auto& part, Range range) {
        for (std::uint64_t row = part.begin(); row < part.end();) {
          const CopyFacet first = facets.at(row);
          const std::uint64_t last = std::min(facets.facet_count(first.copy), first.facet + (part.end() - row));
          facets.visit(first.copy, first.facet, last,
                       [&](std::uint64_t, const Triangle& corners, std::uint32_t, std::uint32_t) { range.add(centroid_height(corners)); });
          row += last - first.facet;
        }
        return range;
      },
      [](Range a, const Range& b) {
        return Range{std::min(a.low, b.low), std::max(a.high, b.high)};
      });
}

}  // namespace

HeightProfile::HeightProfile(const FacetRows& facets, std::size_t states, std::size_t bands)
    : area(layers, 0.0), absorbed(states * layers * bands, 0.0), bands_(bands) {
  Range range = heights(facets);
  if (facets.placed().first_ground_facet == 0) range.low = range.high = 0.0;
  for (std::size_t i = 0; i <= layers; ++i) height.push_back(range.low + (range.high - range.low) * static_cast<double>(i) / layers);
  low_ = range.low;
  scale_ = range.high > range.low ? layers / (range.high - range.low) : 0.0;
}

std::size_t HeightProfile::layer(const Triangle& corners) const {
  return static_cast<std::size_t>(std::clamp((centroid_height(corners) - low_) * scale_, 0.0, layers - 1.0));
}

}  // namespace sunfleck
