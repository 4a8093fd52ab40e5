#include <sunfleck/instantiation/plan.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/counts.hpp>

#include "instantiation/batches.hpp"
#include "instantiation/members.hpp"
#include "instantiation/opening.hpp"
#include "instantiation/surroundings.hpp"
#include "instantiation/threads.hpp"

namespace sunfleck {

namespace {

constexpr std::uint64_t small_scene = 2'000'000;  // facets
constexpr std::uint64_t fewest_facets = 20'000;

/// Entries of rows after so many samples (directions x lines), from those of two pilots of which the second has twice the first's.
double extrapolated(std::size_t few, std::size_t more, double factor) {
  if (few == 0 || more == 0) return 0.0;
  // merging grows as rows fill, so that the exponent falls on; by .06 on crowns and plants
  const double exponent = std::clamp(std::log2(static_cast<double>(more) / static_cast<double>(few)) - 0.06, 0.5, 1.0);
  return static_cast<double>(more) * std::pow(factor, exponent);
}

}  // namespace

std::uint64_t InstantiationPlan::memory_total() const {
  std::uint64_t total = 0;
  for (const auto& [name, bytes] : memory) total += bytes;
  return total;
}

bool repeats(const Scene& scene) {
  const auto counts = count(scene);
  return counts.plant_facets >= fewest_facets && counts.plant_facets >= 2 * counts.unique_facets;
}

InstantiationDensity adapted(InstantiationDensity density, std::uint64_t facets) {
  if (facets < small_scene) {
    density.coarse.directions *= 2;
    density.coarse.lines_per_organ *= 1.5;
  } else {
    density.sun_lines_per_organ *= 0.5;
  }
  return density;
}

InstantiationPlan plan_instantiation(const Scene& scene, const PlacedScene& placed, const InstantiationSettings& settings,
                                     Progress& progress) {
  check_instantiable(scene);
  const auto density = adapted(settings.density, placed.solved_facets());
  OperatorDensity pilot = density.coarse;
  pilot.directions = 16;
  const auto members = make_members(scene, placed, settings.classes, pilot, density.elements_per_organ, settings.seed, progress);
  InstantiationPlan plan;
  plan.originals = members.originals.size();
  plan.copies = members.size();
  plan.merged_copies = members.merged;
  plan.tangled = members.tangled;
  const std::size_t columns = scene.states.size() * scene.band_count();
  const auto samples = [](const OperatorDensity& d) { return d.directions * d.lines_per_organ; };
  const auto bytes_of_operator = [&](const LineOperator& few, const LineOperator& more, const OperatorDensity& d, std::size_t sides_seen,
                                     double& links) {
    const double factor = samples(d) / samples(pilot);
    links = extrapolated(few.inside.size(), more.inside.size(), factor);
    const double exits = extrapolated(few.outside.size(), more.outside.size(), factor);
    const double fields = 2.0 * d.directions * d.field_pixels * d.field_pixels;
    return LinkRows::bytes_per_link(sides_seen) * links + LinkRows::bytes_per_link(static_cast<std::size_t>(fields)) * exits +
           16.0 * static_cast<double>(more.lines.size()) + (8.0 + 12.0 * d.points) * fields;
  };
  const auto threads = static_cast<double>(threads_at_work());
  // lists of links, 6 bytes each, of some directions, and a bundle of lines a thread
  const auto to_make = [&](const Elements& e, const OperatorDensity& d) {
    const double hits = 0.5 * std::accumulate(e.area.begin(), e.area.end(), 0.0) / (0.5 * e.organ_area / d.lines_per_organ);
    const double together = std::min(d.directions, directions_together(hits));
    return hits * (together * 2 * 6 + threads * 60);
  };
  std::vector<std::uint64_t> copies(members.originals.size(), 0), opened(copies);
  for (std::size_t m = 0; m < members.size(); ++m) {
    ++copies[members.found.members[m].original];
    opened[members.found.members[m].original] += members.found.members[m].copies.front() < placed.copies.size();
  }
  double shared = 0, fine = 0, links = 0, making = 0, lanes = 0, rows = 0;
  for (std::size_t k = 0; k < members.originals.size(); ++k) {
    const auto& o = members.originals[k];
    OperatorDensity half = pilot;
    half.directions /= 2;
    const LineOperator few(o.elements, o.interior, half, settings.seed, progress);
    double coarse_links = 0, fine_links = 0;
    shared +=
        static_cast<double>(o.elements.bytes()) + bytes_of_operator(few, *o.coarse, density.coarse, 2 * o.elements.size(), coarse_links);
    const OperatorDensity gather = gather_density(density, opened[k]);
    const double all_fine = bytes_of_operator(few, *o.coarse, gather, 2 * o.elements.surface.cells(), fine_links);
    const auto of_copies = static_cast<double>(copies[k] * columns);
    const double width = batch_width(copies[k] * columns, columns);
    const double side_lanes = 4 * width * 2 * static_cast<double>(o.elements.size()),
                 cells = 4 * width * 2 * static_cast<double>(o.elements.surface.cells());
    const bool once = of_copies <= width;  // then its lines are followed and not kept
    const double sums =
        once ? LineVisitor::streams * side_lanes + cells - fine_links * LinkRows::bytes_per_link(2 * o.elements.surface.cells()) : 0.0;
    fine = std::max(fine, all_fine + sums + to_make(o.elements, gather));
    making = std::max(making, to_make(o.elements, density.coarse));
    lanes = std::max(lanes, std::min(threads, std::ceil(of_copies / width)) * (3 * side_lanes + cells));
    const auto facets = static_cast<double>(members.found.originals[k].facets);
    rows = std::max(rows, std::min(static_cast<double>(copies[k]) * facets * 8 * static_cast<double>(columns + scene.states.size()),
                                   double{opening_window_bytes}));
    links += coarse_links;
    plan.elements += o.elements.size();
  }
  plan.links = static_cast<std::uint64_t>(links);
  const auto lights = light_sources(scene.states);
  std::uint64_t cells = 0;
  for (std::size_t m = 0; m < members.size(); ++m) cells += members.original_of(m).elements.surface.cells();
  const double pixels = double(density.coarse.field_pixels) * density.coarse.field_pixels;
  const double fields = 2.0 * density.coarse.directions * pixels * static_cast<double>(members.size());
  plan.memory.emplace_back("plants", held_bytes(scene));
  plan.memory.emplace_back("originals", static_cast<std::uint64_t>(shared + making));
  if (!lights.suns.empty()) plan.memory.emplace_back("sun", lights.suns.size() * cells + 4 * cells);
  const Surroundings around(members, placed);
  plan.memory.emplace_back("rays", around.bytes() + static_cast<std::uint64_t>(fields * density.coarse.points * sizeof(RayEnd)) +
                                       (placed.ground.size() + placed.near_ground.size()) * density.ground_rays * sizeof(RayEnd));
  plan.memory.emplace_back("fields", static_cast<std::uint64_t>(6 * 4 * fields * static_cast<double>(columns)));
  plan.memory.emplace_back("lanes", static_cast<std::uint64_t>(lanes));
  plan.memory.emplace_back("rows", static_cast<std::uint64_t>(rows));
  plan.memory.emplace_back("fine", static_cast<std::uint64_t>(fine));
  return plan;
}

}  // namespace sunfleck
