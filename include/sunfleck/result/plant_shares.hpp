// What each plant of a scene absorbs, by what its surfaces count as.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sunfleck {

class Result;

/// p plants as the scene lists them (all copies of one together), s states, b bands; of facets with rows.
struct PlantShares {
  std::size_t states = 0, bands = 0;
  std::vector<std::string> names;   ///< [p]
  std::vector<double> leaf, other;  ///< [s][p][b] absorbed by facets whose optics count as leaf, and by the others [W]

  PlantShares() = default;
  PlantShares(std::size_t state_count, std::size_t band_count, std::vector<std::string> plants)
      : states(state_count),
        bands(band_count),
        names(std::move(plants)),
        leaf(states * names.size() * bands, 0.0),
        other(leaf.size(), 0.0) {}

  std::size_t at(std::size_t state, std::size_t plant, std::size_t band) const { return (state * names.size() + plant) * bands + band; }
  /// Absorbed by all that does not count as leaf [W].
  double other_of_all(std::size_t state, std::size_t band) const {
    double sum = 0.0;
    for (std::size_t p = 0; p < names.size(); ++p) sum += other[at(state, p, band)];
    return sum;
  }
};

/// /balance/plants; none in results of older versions. Throws InputError on shapes that contradict each other.
std::optional<PlantShares> plant_shares(const Result& result);

}  // namespace sunfleck
