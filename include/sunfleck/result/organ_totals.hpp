// Sums of a solution over some of its organs, and over all plants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunfleck {

/// s states, k organs that were asked for, b bands.
struct OrganTotals {
  std::size_t states = 0, bands = 0;
  std::vector<std::uint64_t> organs;     ///< [k] rows of /organs, rising
  std::vector<double> irradiance;        ///< [s][k][2][b] sum over facets of area x irradiance, front and back [W]
  std::vector<double> absorbed;          ///< [s][k][b] [W]
  std::vector<double> area;              ///< [k] one-sided [m^2]
  std::vector<double> plant_irradiance;  ///< [s][b] front and back, of all organs of plants [W]
  std::vector<double> plant_absorbed;    ///< [s][b] [W]
  double plant_area = 0;                 ///< [m^2]

  OrganTotals() = default;
  OrganTotals(std::size_t state_count, std::size_t band_count, std::vector<std::uint64_t> rows)
      : states(state_count),
        bands(band_count),
        organs(std::move(rows)),
        irradiance(states * organs.size() * 2 * bands),
        absorbed(states * organs.size() * bands),
        area(organs.size()),
        plant_irradiance(states * bands),
        plant_absorbed(states * bands) {}

  double absorbed_power(std::size_t state, std::size_t k, std::size_t band) const {
    return absorbed[(state * organs.size() + k) * bands + band];
  }
};

}  // namespace sunfleck
