// Structures that others stand in for while they are closed: approximate instancing.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/policy/classes.hpp>
#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

/// What stands for a closed structure of a plant, or what of the plant is in none.
struct StandInPiece {
  std::uint32_t piece = 0;  ///< row of Approximation::pieces
  Affine map;               ///< piece's frame -> plant frame
  bool rest = false;        ///< the plant's own: what no class holds
};

/// Plants as sets of pieces that plants alike share.
struct Approximation {
  std::vector<PlantEntry> pieces;                    ///< representatives of classes, and for each plant what no class holds
  std::vector<std::vector<StandInPiece>> of_plant;   ///< [plants]; empty: the plant is taken as it is
  std::vector<std::vector<std::uint32_t>> piece_of;  ///< [plants][structures] row of of_plant[plant]
  std::uint64_t closed = 0;                          ///< structures that another stands in for
};

/// Plants that name a policy and are placed once, in finite scenes: their outermost structures with a class of the policy are closed,
/// where the representative's area is within a factor of 4 of their own. Plants
/// placed more often share their own geometry, which is exact.
Approximation approximate(const Scene& scene, const PlacedScene& placed, const Classification& classes);

}  // namespace sunfleck
