#include "audit/solved_light.hpp"

#include <algorithm>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double least_absorbed = 1e-6;  // of the incident light

}  // namespace

bool compares_irradiance(const std::vector<std::vector<Balance>>& balance, std::size_t band) {
  double leaves = 0.0, incident = 0.0;
  for (const auto& state : balance) leaves += state[band].leaves, incident += state[band].incident;
  return incident > 0.0 && leaves < least_absorbed * incident;
}

std::vector<std::size_t> places_of(const std::vector<ChosenOrgan>& chosen, const OrganTotals& solved) {
  std::vector<std::size_t> places;
  for (const auto& c : chosen) {
    const auto at = std::lower_bound(solved.organs.begin(), solved.organs.end(), c.organ);
    if (at == solved.organs.end() || *at != c.organ) throw Error("certificate: the solved light of other organs than those chosen");
    places.push_back(static_cast<std::size_t>(at - solved.organs.begin()));
  }
  return places;
}

double solved_per_area(const OrganTotals& solved, std::size_t state, std::size_t place, std::size_t band, bool irradiance) {
  if (!(solved.area[place] > 0.0)) return 0.0;
  if (!irradiance) return solved.absorbed_power(state, place, band) / solved.area[place];
  const double* sides = &solved.irradiance[((state * solved.organs.size() + place) * 2) * solved.bands + band];
  return (sides[0] + sides[solved.bands]) / solved.area[place];
}

double mean_light(const OrganTotals& solved, std::size_t band, bool irradiance) {
  double light = 0.0;
  for (std::size_t s = 0; s < solved.states; ++s)
    light += (irradiance ? solved.plant_irradiance : solved.plant_absorbed)[s * solved.bands + band] / static_cast<double>(solved.states);
  return solved.plant_area > 0.0 ? light / solved.plant_area : 0.0;
}

}  // namespace sunfleck
