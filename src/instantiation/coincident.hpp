// Copies that lie exactly on each other.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Pairs of members of one original of which no part is farther from the other's than 1e-6 of the scene's size: neighbours in a chain for
/// each such place. Their facets shade each other though nothing stands between them, and no ray can tell which comes first.
std::vector<std::pair<std::uint32_t, std::uint32_t>> coincident_members(const Members& members);

}  // namespace sunfleck
