#include <sunfleck/audit/solve_difference.hpp>

#include "audit/error_interval.hpp"
#include "audit/solved_light.hpp"

namespace sunfleck {

SolveDifference solve_difference(const std::vector<ChosenOrgan>& compared, const OrganTotals& coarse, const OrganTotals& fine,
                                 const std::vector<std::vector<Balance>>& balance) {
  const auto in_coarse = places_of(compared, coarse), in_fine = places_of(compared, fine);
  SolveDifference out;
  for (std::size_t b = 0; b < fine.bands; ++b) {
    const bool irradiance = compares_irradiance(balance, b);
    std::vector<OrganError> apart;
    for (std::size_t k = 0; k < compared.size(); ++k) {
      OrganError organ{.share = compared[k].share, .certain = compared[k].certain};
      for (std::size_t s = 0; s < fine.states; ++s) {
        const double d = solved_per_area(coarse, s, in_coarse[k], b, irradiance) - solved_per_area(fine, s, in_fine[k], b, irradiance);
        organ.difference += d / static_cast<double>(fine.states);
        organ.square += d * d / static_cast<double>(fine.states);
      }
      apart.push_back(organ);
    }
    const ErrorEstimate estimate = estimate_error(apart);
    const double mean = mean_light(fine, b, irradiance);
    const auto relative = [mean](double square) { return mean > 0.0 ? square / (mean * mean) : 0.0; };
    out.square.push_back(relative(estimate.rmse * estimate.rmse));
    out.square_standard_error.push_back(relative(estimate.square_standard_error));
  }
  return out;
}

}  // namespace sunfleck
