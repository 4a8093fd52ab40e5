// The accuracy of a solve, as found by path tracing some of its organs: data only, computed by audit, kept in the result file.
#pragma once

#include <cstdint>
#include <vector>

namespace sunfleck {

/// s states, k checked organs, b bands. Error measures are fractions of the mean absorbed power per area of the checked organs' plants,
/// after the Error definition of docs/formats-result.md; over all states together (weighted as they are listed).
struct Certificate {
  std::vector<std::uint64_t> organs;          ///< [k] rows of /organs, rising
  std::vector<float> solved;                  ///< [s][k][b] absorbed power [W]
  std::vector<float> reference;               ///< [s][k][b] absorbed power by path tracing [W]
  std::vector<float> standard_error;          ///< [s][k][b] of `reference` [W]
  std::vector<double> rmse;                   ///< [b] estimate, the reference's noise taken out [-]
  std::vector<double> rmse_low, rmse_high;    ///< [b] ends of the 95 % interval [-]
  std::vector<double> bias;                   ///< [b] [-]
  std::vector<double> bias_standard_error;    ///< [b] [-]; empty = not estimated
  std::vector<double> square_standard_error;  ///< [b] of rmse^2 before it is cut at zero [-]; not kept in the file
  std::vector<double> wanted;                 ///< [b] the error that was asked for, 0 where none was [-]; empty = none at all
  std::uint64_t rays = 0;
  std::uint64_t seed = 0;
};

}  // namespace sunfleck
