// Weighted links of an operator, row by row, and how they are made without holding every line at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunfleck {

/// Some consecutive rows.
template <class Column>
struct LinkPart {
  std::vector<std::uint32_t> start;  ///< [rows + 1]
  std::vector<Column> column;
  std::vector<std::uint8_t> count;  ///< lines; more than 255 take several entries

  bool operator==(const LinkPart&) const = default;
};

/// Rows of (column, lines), sorted by column, in parts of 2^shift rows. Columns take two bytes where there are few, else four.
struct LinkRows {
  static constexpr std::size_t padding = 16;  ///< columns beyond the last of a part, so that loops may look ahead
  static constexpr std::size_t most_narrow = 65536;
  unsigned shift = 0;
  std::vector<LinkPart<std::uint16_t>> narrow;
  std::vector<LinkPart<std::uint32_t>> wide;  ///< one of the two is empty

  /// call(columns, counts, number) with the entries of a row.
  template <class Call>
  void row(std::size_t i, Call&& call) const {
    if (!narrow.empty())
      in_part(narrow[i >> shift], i & ((std::size_t{1} << shift) - 1), call);
    else
      in_part(wide[i >> shift], i & ((std::size_t{1} << shift) - 1), call);
  }
  /// What an entry takes where there are so many columns.
  static constexpr double bytes_per_link(std::size_t columns) { return columns <= most_narrow ? 3.0 : 5.0; }
  /// Entries of all rows, and of the part that has most.
  std::size_t size() const;
  std::size_t largest_part() const;
  std::size_t parts() const { return narrow.size() + wide.size(); }
  /// Lines of all entries.
  std::uint64_t lines() const;
  std::size_t bytes() const;
  bool operator==(const LinkRows&) const = default;

 private:
  template <class Column, class Call>
  static void in_part(const LinkPart<Column>& part, std::size_t i, Call&& call) {
    const auto begin = part.start[i];
    call(part.column.data() + begin, part.count.data() + begin, std::size_t{part.start[i + 1]} - begin);
  }
};

/// Shall so many entries that wait be merged into so many links? Every merge copies all links: lists wait until they are a quarter of
/// them, so that a link is copied a few times however many lists come, and what waits takes about a third of the room of what is kept.
bool merge_is_due(std::uint64_t waiting, std::uint64_t kept);

/// The parts of LinkRows in the making.
template <class Column>
class LinkParts {
 public:
  LinkParts(std::size_t rows, unsigned shift);

  std::size_t begin(std::size_t lists) {
    lists_.resize(lists_.size() + lists);
    return lists_.size() - lists;
  }

  template <class Visit>
  void put(std::size_t list, const Visit& visit) {
    List& out = lists_[list];
    out.start.assign(parts_.size() + 1, 0);
    visit([&](std::uint32_t row, std::uint32_t) { ++out.start[(row >> shift_) + 1]; });
    for (std::size_t r = 0; r < parts_.size(); ++r) out.start[r + 1] += out.start[r];
    out.row.resize(out.start.back());
    out.column.resize(out.start.back());
    auto cursor = out.start;
    visit([&](std::uint32_t row, std::uint32_t column) {
      const auto at = cursor[row >> shift_]++;
      out.row[at] = static_cast<std::uint16_t>(row & ((1u << shift_) - 1u));
      out.column[at] = static_cast<Column>(column);
    });
  }

  bool due() const;
  void merge();
  std::vector<LinkPart<Column>> finish();
  std::size_t peak() const { return peak_; }

 private:
  struct List {
    std::vector<std::uint64_t> start;  ///< [parts + 1]
    std::vector<std::uint16_t> row;    ///< within its part
    std::vector<Column> column;
  };

  unsigned shift_;
  std::vector<LinkPart<Column>> parts_;
  std::vector<List> lists_;
  std::size_t peak_ = 0;
};

/// Makes LinkRows from entries (row, column) that arrive in lists, many of them the same: lists are sorted into parts as they come, and
/// merged into what is kept. Held are the rows so far, 3 or 5 bytes a link, and 4 or 6 bytes for each entry since the last merge. The rows
/// do not depend on how entries are shared out to lists and merges.
class LinkRowsBuilder {
 public:
  LinkRowsBuilder(std::size_t rows, std::size_t columns);

  /// Room for so many lists more; returns the number of the first.
  std::size_t begin(std::size_t lists) { return is_narrow_ ? narrow_.begin(lists) : wide_.begin(lists); }

  /// The entries of one list; lists in any number of threads. `visit(call)` calls call(row, column) for each, twice over the same.
  template <class Visit>
  void put(std::size_t list, const Visit& visit) {
    is_narrow_ ? narrow_.put(list, visit) : wide_.put(list, visit);
  }

  /// merge_is_due() of the lists?
  bool due() const { return is_narrow_ ? narrow_.due() : wide_.due(); }
  /// Takes the lists in and forgets them.
  void merge() { is_narrow_ ? narrow_.merge() : wide_.merge(); }
  /// The rows; nothing is left here.
  LinkRows finish();
  /// The most that was held at any time until now, lists and what merges work in included [bytes].
  std::size_t peak() const { return narrow_.peak() + wide_.peak(); }

 private:
  bool is_narrow_;
  unsigned shift_;
  LinkParts<std::uint16_t> narrow_;
  LinkParts<std::uint32_t> wide_;
};

}  // namespace sunfleck
