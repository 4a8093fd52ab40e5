#include <sunfleck/solver/organ_views.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include <sunfleck/core/cosine_direction.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "solver/prepared_scene.hpp"

namespace sunfleck {

namespace {

/// Rays of one side: how many leave for the sky, and meet the ground.
struct Seen {
  std::uint32_t sky = 0, ground = 0;
};

std::array<Seen, 2> look(const FacetRows& rows, const RayScene& rays, const SampleTarget& target, std::uint32_t count, std::uint64_t seed) {
  std::array<Seen, 2> seen;
  const auto scramble = static_cast<std::uint32_t>(mix(seed, target.key()));
  for (std::uint32_t i = 0; i < count; ++i) {
    double within = 0;
    const CopyFacet facet = target.facet_at(sobol_owen(i, 0, scramble), within);
    const Triangle corners = rays.met_corners(facet);
    const double r = std::sqrt(within), v = r * sobol_owen(i, 1, scramble);  // even over the triangle
    const Vec3 point = corners[0] + (r - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
    const Vec3 normal = glm::normalize(area_vector(corners));
    for (unsigned side = 0; side < 2; ++side) {
      const Vec3 direction =
          cosine_direction(side == 0 ? normal : -normal, sobol_owen(i, 2 + 2 * side, scramble), sobol_owen(i, 3 + 2 * side, scramble));
      const RayHit hit = rays.first_hit(point, direction, facet);
      if (!hit)
        seen[side].sky += rays.periodic() ? rays.periodic()->above(direction) > 0 : direction.z > 0;
      else
        seen[side].ground += rows.is_ground(hit.copy);
    }
  }
  return seen;
}

}  // namespace

OrganViews organ_views(const Scene& given, std::uint32_t count, std::uint64_t seed, Progress& progress) {
  const PreparedScene prepared(given);
  const Scene& scene = prepared.scene();
  const PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  const RayScene rays(rows);
  OrganViews views;
  views.count = placed.organs;
  views.sky.resize(2 * placed.organs);
  views.ground.resize(2 * placed.organs);
  constexpr std::uint64_t block = 256;  // organs between two questions whether to stop
  for (std::uint64_t first = 0; first < placed.organs; first += block) {
    progress.check();
    progress.fraction("views", static_cast<double>(first) / static_cast<double>(placed.organs));
    tbb::parallel_for(first, std::min(first + block, placed.organs), [&](std::uint64_t organ) {
      const auto [copy, local] = rows.organ_at(organ);
      std::vector<CopyFacet> facets;
      for (const auto f : rows.organ_facets(copy, local)) facets.push_back({copy, f});
      const SampleTarget target(rays, std::move(facets), organ);
      if (!(target.area() > 0)) return;
      const auto seen = look(rows, rays, target, count, seed);
      for (std::size_t side = 0; side < 2; ++side) {
        views.sky[2 * organ + side] = static_cast<double>(seen[side].sky) / count;
        views.ground[2 * organ + side] = static_cast<double>(seen[side].ground) / count;
      }
    });
  }
  return views;
}

}  // namespace sunfleck
