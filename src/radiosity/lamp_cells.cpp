#include "lamp_cells.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/ground_gap.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t lamp_stream = 0x6c616d7073ULL;

/// Calls visit(number, patch) for the cells of a triangle split k times, in the order of cell_of().
template <class Visit>
void each_cell(const Triangle& corners, int k, Visit&& visit) {
  const Vec3 u = (corners[1] - corners[0]) / static_cast<double>(k), v = (corners[2] - corners[0]) / static_cast<double>(k);
  std::uint32_t number = 0;
  for (int j = 0; j < k; ++j)
    for (int i = 0; i < k - j; ++i) {
      const Vec3 at = corners[0] + static_cast<double>(i) * u + static_cast<double>(j) * v;
      visit(number++, Patch{at, u, v, true});
      if (i < k - 1 - j) visit(number++, Patch{at + u + v, -u, -v, true});
    }
}

}  // namespace

std::size_t LampIrradiance::bytes() const {
  std::size_t total = 0;
  for (const auto& set : sets) total += bytes_of(set);
  return total;
}

std::uint32_t lamp_rays(double cell_area, double patch_area, const RadiosityDensity& density) {
  return static_cast<std::uint32_t>(std::clamp(std::ceil(density.sun_lines_per_organ / 6.0 * cell_area / patch_area), 4.0, 4096.0));
}

std::uint64_t lamp_rays(const Elements& e, const RadiosityDensity& density) {
  const auto& s = e.surface;
  std::uint64_t rays = 0;
  for (std::size_t t = 0; t < s.size(); ++t)
    if (s.split[t] > 0) rays += std::uint64_t{s.first_cell[t + 1] - s.first_cell[t]} * lamp_rays(s.cell_area[t], e.patch_area, density);
  return rays;
}

LampIrradiance lamp_irradiance(const LampLight& lamps, const FacetScene& facets, const Elements& e, const RadiositySettings& settings,
                               const Surroundings& scene, Progress& progress) {
  LampIrradiance out;
  const auto& s = e.surface;
  const std::size_t bands = lamps.bands(), sets = lamps.lamps().sets.size(), rows = s.size();
  out.set_of_state = lamps.lamps().set_of_state;
  out.sets.assign(sets, std::vector<float>(2 * s.cells() * bands, 0.0f));
  out.rays = lamp_rays(e, settings.density);
  const GroundGap gap(facets);
  constexpr std::size_t block = 2048;
  for (std::size_t first = 0; first < rows; first += block) {
    progress.check();
    progress.fraction("lamps", static_cast<double>(first) / static_cast<double>(rows));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, std::min(rows, first + block), 32), [&](const auto& range) {
      std::vector<double> light(lamps.values());
      for (std::size_t t = range.begin(); t < range.end(); ++t) {
        if (s.split[t] == 0 || progress.cancelled()) continue;
        const auto facet = e.order[t];
        const auto rays = lamp_rays(s.cell_area[t], e.patch_area, settings.density);
        const Triangle& given = e.pieces.corners_of(t, facets.corners[facet]);
        each_cell(facet < facets.plant_facets ? given : gap.lowered(given), s.split[t], [&](std::uint32_t number, const Patch& patch) {
          std::fill(light.begin(), light.end(), 0.0);
          lamps.on_patch(patch, facet, 0.0, rays, mix(mix(settings.seed, lamp_stream), facet, number), scene, 1.0, light.data());
          const std::size_t cell = s.first_cell[t] + number;
          for (std::size_t k = 0; k < sets; ++k)
            for (std::size_t i = 0; i < 2 * bands; ++i) out.sets[k][2 * cell * bands + i] = static_cast<float>(light[2 * k * bands + i]);
        });
      }
    });
  }
  progress.fraction("lamps", 1.0);
  return out;
}

}  // namespace sunfleck
