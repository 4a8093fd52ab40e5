#include "solver/lattice_run.hpp"

#include <algorithm>
#include <optional>

#include <sunfleck/light/sky_parts.hpp>

#include "solver/direct_rays.hpp"

namespace sunfleck {

SolveReport solve_with_lattice(const Scene& scene, const PlacedScene& placed, const FacetScene& facets, const RadiositySettings& direct,
                               bool rough, const LatticeSettings& lattice, IrradianceSink& sink, Progress& progress) {
  check_lattice(scene, facets, lattice);
  KeptLight kept(scene.states.size(), facets.size(), scene.band_count());
  const bool copies = placed.copies.size() > scene.plants.size();
  // Where copies make up a draft, rays through their tree cost as much as facets; lines cost as much as directions times facets.
  const bool detail =
      std::any_of(scene.states.begin(), scene.states.end(), [](const LightState& s) { return s.sky && has_detail(*s.sky); });
  const bool by_rays = rough && copies && scene.lamps.empty() && !detail;
  Stopwatch watch;
  const FacetRows rows(scene, placed);
  std::optional<RayScene> rays;
  if (by_rays || lattice.mapping == LatticeMapping::matched) {
    if (copies)  // whose tree is that of their plants
      rays.emplace(rows);
    else
      rays.emplace(facets);
  }
  const double tree_seconds = watch.seconds();
  const auto first = by_rays ? direct_by_rays(scene, facets, *rays, {{lattice.seed, lattice.threads}}, kept, progress)
                             : solve_radiosity(scene, facets, direct, kept, progress);
  auto report = solve_lattice(scene, facets, {kept, first.balance, rays ? &*rays : nullptr}, lattice, sink, progress);
  report.timings.insert(report.timings.begin(), first.timings.begin(), first.timings.end());
  report.counts.insert(report.counts.begin(), first.counts.begin(), first.counts.end());
  report.memory.insert(report.memory.begin(), first.memory.begin(), first.memory.end());
  if (rays) {
    report.timings.emplace(report.timings.begin(), "tree of rays", tree_seconds);
    report.memory.emplace_back("tree of rays", rays->bytes());
  }
  return report;
}

}  // namespace sunfleck
