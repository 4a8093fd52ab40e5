// Wide facets of the ground, cut finer where plants are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Boxes of plants, seen from above.
class Footprints {
 public:
  /// Many boxes are taken together in one.
  explicit Footprints(std::vector<Box> boxes);
  bool empty() const { return boxes_.empty(); }
  /// Horizontal distance of a triangle's box from the nearest one [m]; 0 where they overlap.
  double distance(const Triangle& t) const;
  /// Of what lies within `margin` of them, from above; overlaps count more than once, but never for more than the box about all [m^2].
  double area(double margin) const;

 private:
  std::vector<Box> boxes_;
  Box all_;
};

/// A piece of a facet: of the 4^level congruent triangles into which halving its edges again and again cuts it, one, numbered as cell_of()
/// numbers the cells of a triangle split 2^level times.
struct GroundPiece {
  Triangle corners;
  std::uint32_t level = 0, number = 0;
};

/// Cuts a facet as long as a piece is larger than max(finest, distance / 2), sizes being sqrt(2 x area), distances those from the plants.
std::vector<GroundPiece> cut_ground_facet(const Triangle& facet, const Footprints& plants, double finest);

/// Finds the piece in which a point of a facet lies.
class GroundPieceIndex {
 public:
  /// `place`: what find() shall return.
  void add(std::uint32_t facet, const GroundPiece& piece, std::uint32_t place);
  bool knows(std::uint32_t facet) const { return facets_.contains(facet); }
  /// u, v: barycentric coordinates of corners 1 and 2 of the facet; they become those of the piece.
  std::uint32_t find(std::uint32_t facet, double& u, double& v) const;
  std::size_t bytes() const;

 private:
  struct Facet {
    std::unordered_map<std::uint64_t, std::uint32_t> place;  ///< by level and number
    std::uint32_t first = 0, deepest = 0;
  };
  std::unordered_map<std::uint32_t, Facet> facets_;
};

}  // namespace sunfleck
