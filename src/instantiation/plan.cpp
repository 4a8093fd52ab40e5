#include <sunfleck/instantiation/plan.hpp>

#include <algorithm>
#include <cmath>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/scene/counts.hpp>

#include "instantiation/members.hpp"
#include "instantiation/surroundings.hpp"

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
    density.sun_lines_per_organ *= 0.3;
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
  double shared = 0, fine = 0, links = 0;
  for (const auto& o : members.originals) {
    OperatorDensity half = pilot;
    half.directions /= 2;
    const LineOperator few(o.elements, o.interior, half, settings.seed, progress);
    double coarse_links = 0, fine_links = 0;
    shared +=
        static_cast<double>(o.elements.bytes()) + bytes_of_operator(few, *o.coarse, density.coarse, 2 * o.elements.size(), coarse_links);
    fine = std::max(fine, bytes_of_operator(few, *o.coarse, density.fine, 2 * o.elements.surface.cells(), fine_links));
    links += coarse_links;
    plan.elements += o.elements.size();
  }
  plan.links = static_cast<std::uint64_t>(links);
  const auto lights = light_sources(scene.states);
  std::uint64_t cells = 0;
  for (std::size_t m = 0; m < members.size(); ++m) cells += members.original_of(m).elements.surface.cells();
  const double pixels = double(density.coarse.field_pixels) * density.coarse.field_pixels;
  const double fields = 2.0 * density.coarse.directions * pixels * static_cast<double>(members.size());
  plan.memory.emplace_back("originals", static_cast<std::uint64_t>(shared));
  if (!lights.suns.empty()) plan.memory.emplace_back("sun", lights.suns.size() * cells + 4 * cells);
  const Surroundings around(members, placed);
  plan.memory.emplace_back("rays", around.bytes() + static_cast<std::uint64_t>(fields * density.coarse.points * sizeof(RayEnd)) +
                                       2 * (placed.ground.size() + placed.near_ground.size()) * density.ground_rays * sizeof(RayEnd));
  plan.memory.emplace_back("fields", static_cast<std::uint64_t>(6 * 4 * fields * static_cast<double>(columns)));
  plan.memory.emplace_back("fine", static_cast<std::uint64_t>(fine));
  return plan;
}

}  // namespace sunfleck
