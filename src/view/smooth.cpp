#include "view/smooth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

std::vector<float> smooth_over_organs(const FacetScene& scene, const std::vector<Vec3>& normals, const std::vector<float>& values,
                                      std::size_t width) {
  struct Corner {
    std::uint64_t key;
    std::uint32_t index;  ///< 3 * facet + corner
    bool operator<(const Corner& other) const { return key != other.key ? key < other.key : index < other.index; }
  };
  const std::size_t n = scene.size();
  std::vector<Corner> corners(3 * n);
  const std::uint32_t ground = static_cast<std::uint32_t>(scene.organs.size());
  for (std::size_t f = 0; f < n; ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = scene.corners[f][c] + 0.0;  // -0 becomes 0
      const std::uint64_t place =
          mix(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), std::bit_cast<std::uint64_t>(p.z));
      corners[3 * f + c] = {mix(place, f >= scene.plant_facets ? ground : scene.organ[f]), static_cast<std::uint32_t>(3 * f + c)};
    }
  tbb::parallel_sort(corners.begin(), corners.end());

  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (i == 0 || corners[i].key != corners[i - 1].key) runs.push_back(i);
  runs.push_back(corners.size());
  std::vector<float> out(3 * n * width);
  tbb::parallel_for(std::size_t{0}, runs.size() - 1, [&](std::size_t r) {
    const std::size_t first = runs[r], last = runs[r + 1];
    const bool crowded = last - first > 64;  // a fan without end: leave its facets alone rather than spend k^2
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t own = corners[i].index / 3;
      float* target = &out[corners[i].index * width];
      double weight = 0;
      std::array<double, 8> sum{};
      for (std::size_t j = first; j < last && !crowded; ++j) {
        const std::uint32_t f = corners[j].index / 3;
        if (!(glm::dot(normals[own], normals[f]) > 0.5)) continue;
        weight += scene.area[f];
        for (std::size_t k = 0; k < width; ++k) sum[k] += static_cast<double>(scene.area[f]) * values[f * width + k];
      }
      for (std::size_t k = 0; k < width; ++k) target[k] = weight > 0 ? static_cast<float>(sum[k] / weight) : values[own * width + k];
    }
  });
  return out;
}

}  // namespace sunfleck
