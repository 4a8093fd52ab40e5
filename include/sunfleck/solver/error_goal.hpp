// The error that a user wants, per band of a scene.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/run_settings.hpp>

namespace sunfleck {

/// Errors that can be asked for: fractions of the mean.
inline constexpr double least_wanted_error = 1e-4, most_wanted_error = 0.5;

/// Wanted rms errors of an organ's absorbed light per band, fractions of the mean; 0 = of this band nothing is asked. Throws UsageError
/// for a band that the scene does not have, one that is named twice, and an error out of its range.
std::vector<double> error_goal(const std::vector<WantedError>& wanted, const std::vector<std::string>& bands);

}  // namespace sunfleck
