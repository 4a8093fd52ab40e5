// Into which class of a policy a structure falls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/policy/policy.hpp>

#include "policy/subtrees.hpp"

namespace sunfleck {

/// The entry of a policy for a structure type, or null.
const PolicyType* entry_for(const Policy& policy, const std::string& type, bool whole_plant);

/// The class's name, "branch: leaf_count [4, 16)"; nothing if the structure is outside of all intervals or lacks a value (counted).
std::optional<std::string> policy_key(const Policy& policy, const PolicyType& entry, const Subtrees& subtrees, std::uint32_t structure,
                                      std::size_t& lacking);

/// Throws InputError for types that look misspelt and parameters that no structure of the type has in any of the plants; types that are
/// not there are noted.
void check_policy(const Policy& policy, const std::vector<const Subtrees*>& plants, std::vector<std::string>& notes);

}  // namespace sunfleck
