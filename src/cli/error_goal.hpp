// The error that a user wants, per band.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

/// What the command line says: an error for each band named, or one for all, under an empty name.
using NamedErrors = std::vector<std::pair<std::string, double>>;
/// Reads "1%", "0.01", or bands by name, "PAR=1%,NIR=2%"; each from 0.01 % to 50 %. Throws UsageError with what was found and expected.
NamedErrors named_errors(const std::string& text);

/// Wanted rms errors of an organ's absorbed light per band, fractions of the mean; 0 = of this band nothing is asked. Throws UsageError
/// for a band that the scene does not have.
std::vector<double> error_goal(const NamedErrors& named, const std::vector<std::string>& bands);

}  // namespace sunfleck
