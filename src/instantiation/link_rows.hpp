// Weighted links of an operator, row by row, and how they are made without holding every line at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunfleck {

/// Rows of (column, lines), sorted by column.
struct LinkRows {
  static constexpr std::size_t padding = 16;  ///< entries beyond the last, so that loops may look ahead
  std::vector<std::uint64_t> start;           ///< [rows + 1]
  std::vector<std::uint32_t> column;
  std::vector<std::uint8_t> count;  ///< lines; more than 255 take several entries

  std::size_t bytes() const;
};

/// Makes LinkRows from entries (row, column) that arrive in lists, many of them the same: lists are sorted into ranges of rows as they
/// come, and merged into what is kept. Held are the rows so far, 5 bytes a link, and 6 bytes for each entry since the last merge. The rows
/// do not depend on how entries are shared out to lists and merges.
class LinkRowsBuilder {
 public:
  explicit LinkRowsBuilder(std::size_t rows);

  /// Room for so many lists until the next merge.
  void begin(std::size_t lists) { lists_.resize(lists); }

  /// The entries of one list; lists in any number of threads. `visit(call)` calls call(row, column) for each, twice over the same.
  template <class Visit>
  void put(std::size_t list, const Visit& visit) {
    List& out = lists_[list];
    out.start.assign(ranges_.size() + 1, 0);
    visit([&](std::uint32_t row, std::uint32_t) { ++out.start[(row >> shift_) + 1]; });
    for (std::size_t r = 0; r < ranges_.size(); ++r) out.start[r + 1] += out.start[r];
    out.row.resize(out.start.back());
    out.column.resize(out.start.back());
    auto cursor = out.start;
    visit([&](std::uint32_t row, std::uint32_t column) {
      const auto at = cursor[row >> shift_]++;
      out.row[at] = static_cast<std::uint16_t>(row & ((1u << shift_) - 1u));
      out.column[at] = column;
    });
  }

  /// Takes the lists in and forgets them.
  void merge();
  /// The rows; nothing is left here.
  LinkRows finish();
  /// The most that was held at any time until now, lists and what merges work in included [bytes].
  std::size_t peak() const { return peak_; }

 private:
  struct List {
    std::vector<std::uint64_t> start;  ///< [ranges + 1]
    std::vector<std::uint16_t> row;    ///< within its range
    std::vector<std::uint32_t> column;
  };
  struct Range {
    std::vector<std::uint32_t> column;
    std::vector<std::uint8_t> count;
  };

  std::size_t rows_;
  unsigned shift_ = 0;                 ///< a range has 2^shift_ rows, of at most 2^16
  std::vector<std::uint32_t> length_;  ///< [rows] entries kept
  std::vector<Range> ranges_;
  std::vector<List> lists_;
  std::size_t peak_ = 0;
};

}  // namespace sunfleck
