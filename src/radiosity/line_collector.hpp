// What the lines of one direction say: who sees whom, near or far, and what is enclosed.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include <sunfleck/visibility/projection.hpp>

#include "ground_contact.hpp"
#include "line_links.hpp"

namespace sunfleck {

inline constexpr std::uint32_t enclosed_bit = 0x80000000u;  ///< on a side: it is the enclosed part's

/// A line between two sides: the lower fragment's upward side and the upper fragment's downward side.
struct SidePair {
  std::uint32_t low, high;
};

/// A line that a cluster link may stand for.
struct FarPair {
  std::uint32_t low, high;            ///< sides
  std::uint32_t low_node, high_node;  ///< clusters that the oracle chose
};

/// How a hit is linked to the one below it on its line.
enum class HitLink : std::uint8_t { lowest, near, far };

/// All hits of the lines of one direction, line by line, from the lowest to the highest.
struct DirectionLines {
  std::vector<std::uint32_t> cell_side;  ///< upward side of the cell that is hit, see LineBundle
  std::vector<std::uint32_t> side;       ///< upward side of its element, perhaps with the enclosed_bit; `^ 1` is the downward side
  std::vector<HitLink> link;
  std::vector<FarPair> far;  ///< of hits with a far link, in order
  std::vector<OutsideArea> outside;
};

class LineCollector {
 public:
  /// `interior` from interior_sides(), or empty: no organ is hollow. What `contact` says to be covered is enclosed too.
  LineCollector(const Elements& elements, const ClusterTree* tree, double link_error, const std::vector<bool>& interior,
                const GroundContact& contact);
  /// Takes the hits out of the bundle, whose lines run along `direction`.
  void collect(LineBundle& bundle, const Vec3& direction, DirectionLines& out);
  /// From now on all links are near.
  void forget_clusters() { tree_ = nullptr; }
  /// Lines on which each cell is enclosed; empty if nothing is.
  const std::vector<std::atomic<std::uint32_t>>& inside() const { return inside_; }

 private:
  void mark_enclosed(std::uint32_t cell, std::uint32_t& side);
  bool cluster_link(std::uint32_t low, std::uint32_t high, double distance, FarPair& pair) const;

  const Elements& e_;
  const ClusterTree* tree_;
  const float link_error_;
  const GroundContact contact_;
  std::vector<std::uint8_t> interior_;              ///< [sides of cells]; empty if none is
  std::vector<std::atomic<std::uint32_t>> inside_;  ///< [cells] lines; sums of integers do not depend on the order of work
};

}  // namespace sunfleck
