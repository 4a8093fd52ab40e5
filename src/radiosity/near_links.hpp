// Links between sides of elements: counts of lines, one compressed row per side.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace sunfleck {

/// Near links as counts: F_ij = count_ij / lines_i (Sbert 1993; Szirmay-Kalos & Purgathofer 1998). count is symmetric and
/// lines_i = sum_j count_ij + far_i + open_up_i + open_down_i, so energy is conserved and reciprocity holds at any density.
/// A link takes 4 bytes: its column in the low bits, and in those that remain its count less one; a count that does not fit goes on in a
/// further link of the same column. Rows stand in blocks, which are made, and may be freed, one by one.
class NearLinks {
 public:
  std::size_t rows() const { return end_.size(); }
  std::size_t size() const;   ///< links
  std::size_t bytes() const;  ///< [bytes]
  /// Calls f(column, count) for the links of a row; columns never fall.
  template <class F>
  void for_row(std::size_t row, const F& f) const {
    const std::uint32_t* links = blocks_[row >> block_bits_].data();
    const std::uint32_t mask = (std::uint32_t{1} << column_bits_) - 1;
    for (std::uint32_t k = row & ((std::size_t{1} << block_bits_) - 1) ? end_[row - 1] : 0, end = end_[row]; k < end; ++k)
      f(links[k] & mask, (links[k] >> column_bits_) + 1);
  }

 private:
  friend class NearBuilder;
  int block_bits_ = 0, column_bits_ = 0;
  std::vector<std::vector<std::uint32_t>> blocks_;
  std::vector<std::uint32_t> end_;  ///< [rows] of each row in its block
};

/// Collects single lines, in any order, and merges them. A line waits in 4 bytes per end: row within its block, and column.
class NearBuilder {
 public:
  /// Sides are below `most_sides`. Throws Error if there are more than 2^28, which leave no room for a row.
  explicit NearBuilder(std::size_t most_sides);
  /// A line between sides a and b, which learn of each other.
  void add(std::uint32_t a, std::uint32_t b) {
    add_end(a, b);
    add_end(b, a);
  }
  /// Side `row` sees `column`, which does not learn of it.
  void add_end(std::uint32_t row, std::uint32_t column) {
    Waiting& w = waiting_[row >> block_bits_];
    if (w.at == w.end) grow(w);
    *w.at++ = (row & block_mask_) << column_bits_ | column;
  }
  /// Lines of each row are added to `lines` [rows]. The builder is empty afterwards.
  NearLinks finish(std::size_t rows, std::vector<float>& lines);

 private:
  struct Chunk {
    std::unique_ptr<std::uint32_t[]> ends;
    std::size_t size = 0;
  };
  struct Waiting {
    std::uint32_t *at = nullptr, *end = nullptr;
    std::vector<Chunk> chunks;
    std::size_t size = 0;  ///< of all chunks
  };
  static void grow(Waiting& w);

  int block_bits_, column_bits_;
  std::uint32_t block_mask_;
  std::vector<Waiting> waiting_;
};

}  // namespace sunfleck
