// Which copies of a scene are alike, and the originals that stand for them.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/similarity.hpp>
#include <sunfleck/scene/placed_scene.hpp>

#include "instantiation/stand_ins.hpp"

namespace sunfleck {

/// A plant in an original: plant frame -> original frame.
struct OriginalPart {
  std::uint32_t plant = 0;  ///< row of Scene::plants; beyond them, of Approximation::pieces
  Affine map;
};

/// What copies share. One plant; several, where copies reach so far into each other that they have to be solved together.
struct Original {
  std::vector<OriginalPart> parts;
  std::uint64_t facets = 0;
};

/// A copy of an original.
struct Member {
  std::uint32_t original = 0;
  Similarity map;                     ///< original frame -> world
  std::vector<std::uint32_t> copies;  ///< as PlacedScene::plant_of() counts them, one for each part of the original
  bool stands_in = false;             ///< for a structure of the copy, or for the copy without those
};

struct Originals {
  std::vector<Original> originals;
  std::vector<Member> members;  ///< by their first copy; those that light is solved in, then those that stand far away
  std::size_t solved = 0;       ///< members that light is solved in
};

/// Members of PlacedScene::far are lit like others of their original: moves the first of each original that has no other among those in
/// which light is solved, and returns for each that stays far the member that stands for its light, in turns.
std::vector<std::uint32_t> find_stand_ins(Originals& originals);

/// Copies of the same plant with the same optics share an original where their maps differ by a similarity; where a map stretches or
/// shears, the stretched plant is an original of its own.
Originals find_originals(const Scene& scene, const PlacedScene& placed, const Approximation& approximation);

/// Members that `groups` put together (lists of members, each with two or more) become one member of an original that holds them all.
/// Groups whose parts stand alike to each other (within 1e-9 of their distance) share it.
Originals merged(const Originals& from, const std::vector<std::vector<std::uint32_t>>& groups);

}  // namespace sunfleck
