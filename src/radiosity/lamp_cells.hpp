// Direct light of lamps on every cell.
#pragma once

#include <sunfleck/core/progress.hpp>
#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/radiosity/lamp_light.hpp>
#include <sunfleck/radiosity/solve.hpp>

namespace sunfleck {

struct LampIrradiance {
  std::vector<std::vector<float>> sets;     ///< per set of lamps that shine together: [2 * cells][b] [W m^-2]
  std::vector<std::uint32_t> set_of_state;  ///< [s] row of `sets`, or Lamps::none
  std::uint64_t rays = 0;

  bool empty() const { return sets.empty(); }
  float at(std::size_t cell_side, std::size_t state, std::size_t band, std::size_t bands) const {
    const auto k = empty() ? Lamps::none : set_of_state[state];
    return k == Lamps::none ? 0.0f : sets[k][cell_side * bands + band];
  }
  std::size_t bytes() const;
};

/// Points, each with a shadow ray, that a cell gets: in proportion to its area, so that an organ of the mean size gets a sixth of the lines
/// that sunlight takes (half in the shade, its light then comes to 3.4, 1.8 and 1 % at the three qualities), within [4, 4096].
std::uint32_t lamp_rays(double cell_area, double patch_area, const RadiosityDensity& density);
/// Over all cells.
std::uint64_t lamp_rays(const Elements& elements, const RadiosityDensity& density);

LampIrradiance lamp_irradiance(const LampLight& lamps, const FacetScene& facets, const Elements& elements,
                               const RadiositySettings& settings, const Surroundings& scene, Progress& progress);

}  // namespace sunfleck
