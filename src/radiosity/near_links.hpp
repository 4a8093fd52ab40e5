// Links between sides of elements: counts of lines, one compressed row per side.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace sunfleck {

/// Near links as counts: F_ij = count_ij / lines_i (Sbert 1993; Szirmay-Kalos & Purgathofer 1998). count is symmetric and
/// lines_i = sum_j count_ij + far_i + open_up_i + open_down_i, so energy is conserved and reciprocity holds at any density.
/// A link takes 4 bytes: its column in the low bits, and in those that remain its count less one; a count that does not fit goes on in a
/// further link of the same column. Rows stand in the pieces of memory in which their lines had waited: links are made without taking more.
class NearLinks {
 public:
  std::size_t rows() const { return at_.size(); }
  std::size_t size() const;   ///< links
  std::size_t bytes() const;  ///< [bytes]
  /// Calls f(column, count) for the links of a row; columns never fall.
  template <class F>
  void for_row(std::size_t row, const F& f) const {
    const std::uint32_t mask = (std::uint32_t{1} << column_bits_) - 1;
    const std::uint32_t at = at_[row];
    const Piece& piece = blocks_[row >> block_bits_][at >> 16];
    const bool last = row + 1 == at_.size() || (row + 1) >> block_bits_ != row >> block_bits_ || at_[row + 1] >> 16 != at >> 16;
    const std::uint32_t end = last ? piece.used : at_[row + 1] & 0xffffu;
    for (std::uint32_t k = at & 0xffffu; k < end; ++k) f(piece.links[k] & mask, (piece.links[k] >> column_bits_) + 1);
  }

 private:
  friend class NearBuilder;
  struct Piece {
    std::unique_ptr<std::uint32_t[]> links;
    std::uint32_t size = 0, used = 0;
  };
  int block_bits_ = 0, column_bits_ = 0;
  std::vector<std::vector<Piece>> blocks_;  ///< a row begins below 2^16 of one piece, and goes on to its end at most
  std::vector<std::uint32_t> at_;           ///< [rows] piece of its block << 16 | where in it
};

/// out[i][n] = sum over the links of rows [begin, end) of count x values[column][n]: as many of the n together as stay in a processor's
/// registers.
void weighted_sums(const NearLinks& links, const float* values, std::size_t n, float* out, std::size_t begin, std::size_t end);

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
  struct Waiting {
    std::uint32_t *at = nullptr, *end = nullptr;
    std::vector<NearLinks::Piece> pieces;
    std::size_t size = 0;  ///< of all pieces
  };
  static void grow(Waiting& w, std::size_t least = 0);  ///< by a piece of `least` at least

  int block_bits_, column_bits_;
  std::uint32_t block_mask_;
  std::vector<Waiting> waiting_;
};

}  // namespace sunfleck
