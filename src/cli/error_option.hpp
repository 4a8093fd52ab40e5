// The error that a user wants, per band, as the command line has it.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/run_settings.hpp>

namespace sunfleck {

/// Reads "1%", "0.01", or bands by name, "PAR=1%,NIR=2%". Throws UsageError with what was found and expected; limits are error_goal()'s.
std::vector<WantedError> wanted_errors(const std::string& text);

}  // namespace sunfleck
