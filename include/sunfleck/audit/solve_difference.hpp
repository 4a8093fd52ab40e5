// What two solves of one scene say of each other's errors.
#pragma once

#include <vector>

#include <sunfleck/audit/certificate.hpp>
#include <sunfleck/result/organ_totals.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Per band, over all states together: mean square of x - y over organs, weighted by area (x, y absorbed light per area of the two solves;
/// irradiance front + back where plants absorb less than 1e-6 of the incident light), over the square of the mean of y.
struct SolveDifference {
  std::vector<double> square;                 ///< [b] [-]
  std::vector<double> square_standard_error;  ///< [b] from the choice of organs [-]
};

/// `compared`: organs as choose_organs() draws them, of which `coarse` and `fine` hold all; `balance` of the finer solve. No rays, no
/// noise: what it leaves open is which organs were drawn, and how far the two errors go together (cli/refinement.hpp).
SolveDifference solve_difference(const std::vector<ChosenOrgan>& compared, const OrganTotals& coarse, const OrganTotals& fine,
                                 const std::vector<std::vector<Balance>>& balance);

}  // namespace sunfleck
