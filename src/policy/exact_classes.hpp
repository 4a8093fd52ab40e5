// Structures whose geometry is the same up to rotation, mirror, uniform scale and move.
#pragma once

#include <cstdint>
#include <vector>

#include "policy/similarity.hpp"
#include "policy/subtrees.hpp"

namespace sunfleck {

/// A structure of one of the plants that are looked at.
struct SubtreeRef {
  std::uint32_t plant = 0;  ///< row of the list of Subtrees
  std::uint32_t structure = 0;
};

struct ExactMember {
  SubtreeRef subtree;
  Similarity from_first;  ///< plant frame of the first member -> plant frame of this one
};

/// Groups of structures with the same type, facets and optics; those with one member too. In the order of their first members.
std::vector<std::vector<ExactMember>> exact_groups(const std::vector<Subtrees>& plants);

}  // namespace sunfleck
