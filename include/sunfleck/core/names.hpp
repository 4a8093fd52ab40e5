// "Did you mean": the known name nearest to a misspelt one.
#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

/// Optimal string alignment distance (insert, delete, substitute, swap of neighbours), ignoring case.
int edit_distance(std::string_view a, std::string_view b);

/// The known name with the smallest edit distance if that is at most 2 or a third of the length; else empty.
std::string nearest_name(std::string_view found, std::span<const std::string> known);

/// The names as `clean` leaves them, but none twice: one that cleaning changes, or that comes a second time, gets "_2", "_3", ... where its
/// name is another's already or is one of `taken`. Names that stay as they are keep theirs.
std::vector<std::string> distinct_names(std::span<const std::string> names, const std::function<std::string(const std::string&)>& clean,
                                        const std::set<std::string>& taken = {});

/// "a, b, c" for messages.
std::string joined(std::span<const std::string> names);

}  // namespace sunfleck
