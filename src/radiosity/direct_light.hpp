// Direct light of sun and sky on every cell, by parallel projection.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/solution.hpp>

#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Where light comes from, and what of it reaches each side of each cell. Side index: 2 * cell + (0 front, 1 back).
struct DirectLight {
  std::vector<std::uint32_t> sky_of_state;  ///< [s] row of `sky`, or none
  std::vector<std::uint32_t> sun_of_state;  ///< [s] row of `sunlit`, or none
  std::vector<std::vector<float>> sky;      ///< per distinct sky model: irradiance over the sky's horizontal irradiance [2 * cells]
  std::vector<float> sky_seen;  ///< [2 * cells] cosine-weighted fraction of the side's hemisphere that is open sky; empty without sky
  std::vector<std::vector<float>> sunlit;      ///< per sun: fraction of the side that the sun reaches [2 * cells]
  std::vector<std::vector<float>> sun_cosine;  ///< per sun: cosine between each surface row's front normal and the sun [rows]
  std::uint64_t fragments = 0;
  static constexpr std::uint32_t none = LightSources::none;

  std::size_t bytes() const;
};

DirectLight direct_light(const Scene& scene, const FacetScene& facets, const Elements& elements, const RadiositySettings& settings,
                         Timings& timings, Progress& progress);

}  // namespace sunfleck
