// Light on the ground, facet by facet, by rays.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/light/light_sources.hpp>

#include "instantiation/member_surroundings.hpp"

namespace sunfleck {

/// What each facet of the ground sees. Sides: 2 * facet + (0 front, 1 back); backs see nothing unless the sky reaches below the horizon
/// or the ground is a mesh.
struct GroundView {
  std::uint32_t rays = 0;               ///< per side
  std::vector<float> area;              ///< [facets] one-sided [m^2]
  std::vector<bool> seen;               ///< [sides] rays were sent
  bool backs = false;                   ///< some back may see something
  std::vector<RayEnd> ends;             ///< [sides, or facets if no back sees anything][rays]
  std::vector<std::vector<float>> sky;  ///< per distinct sky: irradiance over the sky's horizontal irradiance [sides]
  std::vector<std::vector<float>>
      lit;  ///< per distinct sun: fraction of the facet that it reaches, times the cosine towards the side [sides]
  std::vector<std::vector<float>> sunlit;  ///< per distinct sun: fraction of the side that it reaches [sides]
  std::vector<float> sky_seen;             ///< [sides] fraction of rays that end in the sky or nowhere
  std::size_t first_end(std::size_t side) const { return (backs ? side : side / 2) * rays; }
  std::size_t bytes() const;
};

/// With room for all that is seen, and nothing seen yet.
GroundView empty_ground_view(const Scene& scene, const std::vector<Triangle>& ground, const LightSources& lights, std::uint32_t rays);

GroundView view_from_ground(const Scene& scene, const std::vector<Triangle>& ground, const MemberSurroundings& around,
                            const LightSources& lights, std::uint32_t rays, std::uint32_t sun_samples, std::uint64_t seed,
                            Progress& progress);

}  // namespace sunfleck
