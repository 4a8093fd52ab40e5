#include "instantiation/ground_light.hpp"

#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

std::size_t GroundView::bytes() const {
  std::size_t total = bytes_of(area) + bytes_of(ends) + bytes_of(sky_seen);
  for (const auto* list : {&sky, &lit, &sunlit})
    for (const auto& v : *list) total += bytes_of(v);
  return total;
}

GroundView empty_ground_view(const Scene& scene, const std::vector<Triangle>& ground, const LightSources& lights, std::uint32_t rays) {
  GroundView out;
  const std::size_t facets = ground.size(), sides = 2 * facets;
  out.backs = scene.ground && scene.ground->mesh;
  for (const auto* sky : lights.skies) out.backs = out.backs || sky->reaches_below_horizon();
  out.rays = rays;
  out.area.resize(facets);
  out.seen.assign(sides, false);
  out.ends.resize((out.backs ? sides : facets) * rays);
  out.sky.assign(lights.skies.size(), std::vector<float>(sides, 0.0f));
  out.lit.assign(lights.suns.size(), std::vector<float>(sides, 0.0f));
  out.sunlit = out.lit;
  out.sky_seen.assign(sides, 0.0f);
  for (std::size_t f = 0; f < facets; ++f) {
    out.area[f] = static_cast<float>(glm::length(area_vector(ground[f])));
    out.seen[2 * f] = out.area[f] > 0;
    out.seen[2 * f + 1] = out.backs && out.area[f] > 0;
  }
  return out;
}

GroundView view_from_ground(const Scene& scene, const std::vector<Triangle>& ground, const MemberSurroundings& around,
                            const LightSources& lights, std::uint32_t rays, std::uint32_t sun_samples, std::uint64_t seed,
                            Progress& progress) {
  GroundView out = empty_ground_view(scene, ground, lights, rays);
  const std::size_t facets = ground.size();
  std::vector<std::vector<Vec3>> disc;
  for (const auto* sun : lights.suns) disc.push_back(sun_disc(*sun, std::max(sun_samples, 4u) * 8, mix(seed, 3)));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, facets, 16), [&](const auto& range) {
    for (std::size_t f = range.begin(); f < range.end() && !progress.cancelled(); ++f) {
      if (!out.seen[2 * f]) continue;
      const auto& t = ground[f];
      const Vec3 normal = glm::normalize(area_vector(t));
      const auto key = static_cast<std::uint32_t>(mix(seed, f));
      const auto point = [&](std::uint32_t k, unsigned dimension) {
        double a = std::sqrt(sobol_owen(k, dimension, key)), b = sobol_owen(k, dimension + 1, key);
        return (1 - a) * t[0] + a * (1 - b) * t[1] + a * b * t[2];
      };
      for (std::size_t side = 2 * f; side < 2 * f + 2; ++side) {
        if (!out.seen[side]) continue;
        const Vec3 up = side & 1 ? -normal : normal;
        Vec3 u, v;
        orthonormal_frame(up, u, v);
        std::uint32_t open = 0;
        for (std::uint32_t k = 0; k < rays; ++k) {
          const double r2 = sobol_owen(k, 2, key), angle = 2 * std::numbers::pi * sobol_owen(k, 3, key), r = std::sqrt(r2);
          const Vec3 d = glm::normalize(r * std::cos(angle) * u + r * std::sin(angle) * v + std::sqrt(1 - r2) * up);
          auto& end = out.ends[out.first_end(side) + k];
          end = around.look_from_ground(point(k, 0) + around.ground_lift() * up, d);
          if (!end.is_sky()) continue;
          ++open;
          for (std::size_t s = 0; s < lights.skies.size(); ++s)
            out.sky[s][side] += static_cast<float>(std::numbers::pi * lights.skies[s]->relative_radiance(d) / rays);
        }
        out.sky_seen[side] = static_cast<float>(open) / static_cast<float>(rays);
      }
      for (std::size_t s = 0; s < disc.size(); ++s) {
        const double cosine = glm::dot(normal, lights.suns[s]->direction);
        const std::size_t side = 2 * f + (cosine < 0 ? 1 : 0);
        if (!out.seen[side]) continue;
        const Vec3 lift = (side & 1 ? -around.ground_lift() : around.ground_lift()) * normal;
        std::uint32_t lit = 0;
        const auto n = static_cast<std::uint32_t>(disc[s].size());
        for (std::uint32_t k = 0; k < n; ++k) lit += around.hidden_from_ground(point(k, 4) + lift, disc[s][k]) ? 0 : 1;
        out.sunlit[s][side] = static_cast<float>(lit) / static_cast<float>(n);
        out.lit[s][side] = static_cast<float>(std::fabs(cosine)) * out.sunlit[s][side];
      }
    }
  });
  progress.check();
  return out;
}

}  // namespace sunfleck
