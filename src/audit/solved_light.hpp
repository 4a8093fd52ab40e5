// Solved light of organs, as certificates and comparisons of solves take it.
#pragma once

#include <cstddef>
#include <vector>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Where plants absorb next to nothing of a band, irradiance is compared.
bool compares_irradiance(const std::vector<std::vector<Balance>>& balance, std::size_t band);

/// Rows of the chosen organs in `solved`. Throws Error where one is missing.
std::vector<std::size_t> places_of(const std::vector<ChosenOrgan>& chosen, const OrganTotals& solved);

/// Solved light per area of an organ, absorbed, or irradiance front + back [W m^-2].
double solved_per_area(const OrganTotals& solved, std::size_t state, std::size_t place, std::size_t band, bool irradiance);

/// Mean over all organs of plants and states, per area [W m^-2].
double mean_light(const OrganTotals& solved, std::size_t band, bool irradiance);

}  // namespace sunfleck
