// "Did you mean": the known name nearest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sunfleck {

/// Optimal string alignment distance (insert, delete, substitute, swap of neighbours), ignoring case.
int edit_distance(std::string_view a, std::string_view b);

/// The known name with the smallest edit distance if that is at most 2 or a third of the length; else empty.
std::string nearest_name(std::string_view found, std::span<const std::string> known);

/// "a, b, c" for messages.
std::string joined(std::span<const std::string> names);

}  // namespace sunfleck
