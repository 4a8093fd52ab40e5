#include "lattice/clumping.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include <sunfleck/core/cosine_direction.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

double recollision(const FacetScene& facets, std::size_t leaf_facets, const std::vector<OpenSides>& sides, const RayScene& rays) {
  constexpr std::size_t count = std::size_t{1} << 14, block = 256;
  std::vector<double> above(leaf_facets + 1, 0.0);
  for (std::size_t f = 0; f < leaf_facets; ++f)
    above[f + 1] = above[f] + static_cast<double>(facets.area[f]) * (sides[f] == OpenSides::both ? 2.0 : 1.0);
  if (!(above.back() > 0.0)) return 0.0;
  std::vector<std::size_t> met(count / block, 0);
  tbb::parallel_for(std::size_t{0}, met.size(), [&](std::size_t b) {
    for (std::size_t i = b * block; i < (b + 1) * block; ++i) {
      const double at = above.back() * (static_cast<double>(i) + 0.5) / count;
      const auto f = static_cast<std::uint32_t>(std::min<std::size_t>(
          static_cast<std::size_t>(std::upper_bound(above.begin(), above.end(), at) - above.begin()) - 1, leaf_facets - 1));
      const auto place = r2_point(i), towards = r2_point(i, unit_interval(mix(1)), unit_interval(mix(2)));
      const bool front = sides[f] == OpenSides::front || (sides[f] == OpenSides::both && (mix(i) & 1u) == 0);
      const CopyFacet start = rays.at(f);
      const Triangle t = rays.met_corners(start);
      const double root = std::sqrt(place[0]);
      const Vec3 origin = t[0] + root * (1.0 - place[1]) * (t[1] - t[0]) + root * place[1] * (t[2] - t[0]);
      const Vec3 normal = glm::normalize(area_vector(facets.corners[f]));
      const RayHit hit = rays.first_hit(origin, cosine_direction(front ? normal : -normal, towards[0], towards[1]), start);
      const bool low = hit && leaf_facets < facets.size() && rays.material(hit.where()) + 1 == rays.materials().size();
      if (hit && !low) ++met[b];
    }
  });
  std::size_t all = 0;
  for (const auto m : met) all += m;
  return static_cast<double>(all) / count;
}

double recollision(const LatticeMedium& black, const std::vector<NodeArea>& leaves, const Progress& progress) {
  std::vector<LatticeColumn> column(1);
  column[0].source.assign(black.nodes(), 0.0);
  double sent = 0.0, kept = 0.0;
  for (const auto& leaf : leaves) {
    column[0].source[black.row(leaf.node)] += leaf.area;
    sent += leaf.area;
  }
  const auto steady = steady_state(black, column, {1e-4, 200}, progress, [](std::uint32_t, double) {});
  for (std::size_t i = black.nodes() - black.grid.nodes(); i < black.nodes(); ++i) kept += black.absorbs[i] * steady.columns[0].light[i];
  return sent > 0.0 ? kept / sent : 0.0;
}

double matching_density(double wanted, const std::function<double(double)>& caught) {
  constexpr double widest = 8.0, near = 0.003, nearly_none = 1e-3;
  if (wanted < near) return nearly_none;  // a leaf by itself
  constexpr int most_tries = 10;
  double low = -std::log(widest), high = -low, at = 0.0, before = 0.0, found_before = 0.0;
  for (int tries = 0; tries < most_tries; ++tries) {
    const double found = caught(std::exp(at));
    if (std::abs(found - wanted) < near) break;
    (found < wanted ? low : high) = at;
    const double slope = tries > 0 && at != before ? (found - found_before) / (at - before) : found * (1.0 - found);
    const double guess = slope > 0.0 ? at + (wanted - found) / slope : 0.5 * (low + high);
    before = at, found_before = found;
    at = guess > low && guess < high ? guess : 0.5 * (low + high);
  }
  return std::exp(at);
}

}  // namespace sunfleck
