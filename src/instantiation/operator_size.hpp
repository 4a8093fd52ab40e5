// What a line operator would take, from pilots of few directions.
#pragma once

#include <cstdint>
#include <vector>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Sizes of an operator in full. Fragments, points, and links to the outside are in proportion to the directions: each has fields of its
/// own. Links inside merge where several directions join the same two sides, so that they grow as a power of the directions.
struct OperatorSize {
  double links = 0;      ///< LineOperator::inside, entries
  double points = 0;     ///< LineOperator::points
  double fragments = 0;  ///< LineOperator::fragments
  std::size_t fields = 0;
  double bytes = 0;       ///< LineOperator::bytes()
  double kept = 0;        ///< LineOperator::bytes_kept()
  double built_with = 0;  ///< LineOperator::built_with()
};

/// Of an original's operator along so many directions. `pilots`: operators of the original with the lines of a direction, fields and `seen`
/// of `density` and fewer directions, each with twice as many as the one before. Two tell the exponent with which links grow; a third, how
/// the exponent falls as rows fill, which matters where many directions are wanted (measured from 32 to 256 directions: within 7 % on a
/// random crown, a poplar, a coffee plant, a locust and a tree of 50,000 leaves).
/// `followed`: lines are shown to a visitor, and no links inside are kept; then one pilot will do.
OperatorSize operator_size(const std::vector<const LineOperator*>& pilots, std::uint32_t directions, bool followed = false);

/// A ladder of `count` pilots, from 8 directions on or as many as there are.
std::vector<LineOperator> pilots_of(const OriginalLight& original, OperatorDensity density, std::size_t count, LineOperator::Seen seen,
                                    std::uint64_t seed, Progress& progress);

}  // namespace sunfleck
