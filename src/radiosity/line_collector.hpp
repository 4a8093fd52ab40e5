// What the lines of one direction say: who sees whom, near or far, and what is enclosed.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include <sunfleck/visibility/projection.hpp>

#include "line_links.hpp"

namespace sunfleck {

inline constexpr std::uint32_t enclosed_bit = 0x80000000u;  ///< on a side: it is the enclosed part's

inline constexpr std::uint32_t no_row = 0xffffffffu;

/// A line between two sides: the lower fragment's upward side and the upper fragment's downward side.
struct SidePair {
  std::uint32_t low, high;
};

/// A line that a cluster link may stand for.
struct FarPair {
  std::uint32_t low, high;            ///< sides
  std::uint32_t low_node, high_node;  ///< clusters that the oracle chose
};

/// Who meets the first reflection of the sun's light along a line: a row (a side of an element, or of its enclosed part) and the side of
/// the cell that reflects; `no_row` where the reflected light leaves the scene.
struct FirstReflection {
  std::uint32_t row;
  std::uint32_t cell_side;
};

struct DirectionLines {
  std::vector<SidePair> near;
  std::vector<FarPair> far;
  std::vector<FirstReflection> reflections;       ///< empty without sun
  std::vector<std::uint32_t> withheld;            ///< sides of cells, once per line on which they are enclosed; empty without sun
  std::vector<std::uint32_t> open_up, open_down;  ///< sides, once per line
  std::vector<OutsideArea> outside;
};

/// Sides of organs that face the inside of a hollow body (stems are open tubes): at least 85 % of their lines end on the same side of
/// the same organ (30 % at least) or within a leaf's length, while the other side sees farther. Judged from 16 directions. [2 * organ +
/// side]
std::vector<bool> interior_sides(const Elements& elements, double pitch, std::uint64_t seed, Progress& progress);

class LineCollector {
 public:
  /// `interior` from interior_sides(), or empty: nothing is enclosed.
  LineCollector(const Elements& elements, const ClusterTree* tree, double link_error, std::vector<bool> interior, bool sun);
  void collect(const LineBundle& bundle, DirectionLines& out);
  /// From now on all links are near.
  void forget_clusters() { tree_ = nullptr; }
  /// Fraction of each cell that is enclosed; empty if none is.
  std::vector<float> enclosed() const;

 private:
  std::uint32_t organ(std::uint32_t cell_side) const { return e_.organ_of_row[e_.row_of_cell[cell_side >> 1]]; }
  void mark_enclosed(const std::uint32_t* hit, std::uint32_t n, std::uint32_t* side);
  bool cluster_link(std::uint32_t low, std::uint32_t high, double distance, FarPair& pair) const;

  const Elements& e_;
  const ClusterTree* tree_;
  const float link_error_;
  const std::vector<bool> interior_;
  const bool sun_;
  std::vector<std::atomic<std::uint32_t>> met_, inside_;  ///< [cells] lines; sums of integers do not depend on the order of work
};

}  // namespace sunfleck
