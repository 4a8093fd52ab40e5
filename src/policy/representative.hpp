// Which member stands for a class, and how it stands in for the others.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/policy/policy.hpp>

#include "policy/exact_classes.hpp"

namespace sunfleck {

/// Row of members.
std::uint32_t choose_representative(const PolicyType& entry, const std::vector<Subtrees>& plants, const std::vector<SubtreeRef>& members);

/// Turned as asked, centre of area on centre of area, scaled as asked.
Similarity stand_in(const PolicyType& entry, const std::vector<Subtrees>& plants, const SubtreeRef& representative,
                    const SubtreeRef& member);

}  // namespace sunfleck
