// What options may hold, for the check and for its message.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace sunfleck {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A finite number from `low` to `high`. CLI11's own ranges let NaN pass and do not say what they found.
CLI::Validator number_between(double low, double high);
/// A whole number, digits only.
CLI::Validator count_from(double low, double high = 9007199254740992.0);
/// One of a few names; says which is nearest.
CLI::Validator one_of(std::vector<std::string> names);

}  // namespace sunfleck
