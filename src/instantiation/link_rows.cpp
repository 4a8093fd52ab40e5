#include "instantiation/link_rows.hpp"

#include <algorithm>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t parts_wanted = 64;  // each is one thread's work in a merge, and takes room for itself once more
constexpr unsigned widest_part = 16;      // bits
constexpr std::uint32_t most_count = 255;

template <class Column>
std::size_t bytes_of_parts(const std::vector<LinkPart<Column>>& parts) {
  std::size_t total = 0;
  for (const auto& p : parts) total += bytes_of(p.start) + bytes_of(p.column) + bytes_of(p.count);
  return total;
}

template <class Column>
std::size_t links_of(const std::vector<LinkPart<Column>>& parts) {
  std::size_t total = 0;
  for (const auto& p : parts) total += p.count.size();
  return total;
}

unsigned shift_for(std::size_t rows) {
  unsigned shift = 0;
  while (shift < widest_part && (rows >> shift) >= parts_wanted) ++shift;
  return shift;
}

}  // namespace

/// What a merge of one part works in.
template <class Column>
struct MergeRoom {
  std::vector<std::uint32_t> place, cursor, start;
  std::vector<Column> raw, column;
  std::vector<std::uint8_t> count;

  std::size_t bytes() const {
    return bytes_of(place) + bytes_of(cursor) + bytes_of(start) + bytes_of(raw) + bytes_of(column) + bytes_of(count);
  }
  void add(Column c, std::uint32_t n) {
    for (; n > 0; n -= std::min(n, most_count)) {
      column.push_back(c);
      count.push_back(static_cast<std::uint8_t>(std::min(n, most_count)));
    }
  }
};

std::size_t LinkRows::size() const {
  return links_of(narrow) + links_of(wide);
}
std::size_t LinkRows::largest_part() const {
  std::size_t most = 0;
  for (const auto& p : narrow) most = std::max(most, p.count.size());
  for (const auto& p : wide) most = std::max(most, p.count.size());
  return most;
}
std::uint64_t LinkRows::lines() const {
  std::uint64_t total = 0;
  for (const auto& p : narrow) total = std::accumulate(p.count.begin(), p.count.end(), total);
  for (const auto& p : wide) total = std::accumulate(p.count.begin(), p.count.end(), total);
  return total;
}
std::size_t LinkRows::bytes() const {
  return bytes_of_parts(narrow) + bytes_of_parts(wide);
}

template <class Column>
LinkParts<Column>::LinkParts(std::size_t rows, unsigned shift) : shift_(shift) {
  for (std::size_t low = 0; low < rows; low += std::size_t{1} << shift) {
    parts_.emplace_back();
    parts_.back().start.assign(std::min(rows - low, std::size_t{1} << shift) + 1, 0);
    parts_.back().column.assign(LinkRows::padding, 0);
  }
}

bool merge_is_due(std::uint64_t waiting, std::uint64_t kept) {
  constexpr std::uint64_t fewest = 1'000'000;
  return waiting >= std::max(fewest, kept / 4);
}

template <class Column>
bool LinkParts<Column>::due() const {
  std::uint64_t waiting = 0;
  for (const auto& list : lists_) waiting += list.row.size();
  return merge_is_due(waiting, links_of(parts_));
}

template <class Column>
void LinkParts<Column>::merge() {
  tbb::enumerable_thread_specific<MergeRoom<Column>> rooms;
  tbb::parallel_for(std::size_t{0}, parts_.size(), [&](std::size_t r) {
    auto& kept = parts_[r];
    const std::size_t rows = kept.start.size() - 1;
    auto& room = rooms.local();
    room.place.assign(rows + 1, 0);
    for (const auto& list : lists_)
      if (!list.start.empty())
        for (auto k = list.start[r]; k < list.start[r + 1]; ++k) ++room.place[list.row[k] + 1];
    for (std::size_t i = 0; i < rows; ++i) room.place[i + 1] += room.place[i];
    if (room.place.back() == 0) return;
    room.raw.resize(room.place.back());
    room.cursor = room.place;
    for (const auto& list : lists_)
      if (!list.start.empty())
        for (auto k = list.start[r]; k < list.start[r + 1]; ++k) room.raw[room.cursor[list.row[k]]++] = list.column[k];
    room.column.clear();
    room.count.clear();
    room.start.assign(1, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      Column *next = room.raw.data() + room.place[i], *const end = room.raw.data() + room.place[i + 1];
      std::sort(next, end);
      std::size_t old = kept.start[i];
      const std::size_t old_end = kept.start[i + 1];
      while (old < old_end || next < end) {
        const Column column = next == end ? kept.column[old] : old == old_end ? *next : std::min(*next, kept.column[old]);
        std::uint32_t n = 0;
        for (; old < old_end && kept.column[old] == column; ++old) n += kept.count[old];
        for (; next < end && *next == column; ++next) ++n;
        room.add(column, n);
      }
      room.start.push_back(static_cast<std::uint32_t>(room.column.size()));
    }
    room.column.insert(room.column.end(), LinkRows::padding, 0);
    kept.column = {};
    kept.count = {};
    kept.column.assign(room.column.begin(), room.column.end());
    kept.count.assign(room.count.begin(), room.count.end());
    std::copy(room.start.begin(), room.start.end(), kept.start.begin());
  });
  std::size_t held = bytes_of_parts(parts_);
  for (const auto& room : rooms) held += room.bytes();
  for (const auto& list : lists_) held += bytes_of(list.start) + bytes_of(list.row) + bytes_of(list.column);
  peak_ = std::max(peak_, held);
  lists_ = {};
}

template <class Column>
std::vector<LinkPart<Column>> LinkParts<Column>::finish() {
  return std::move(parts_);
}

template class LinkParts<std::uint16_t>;
template class LinkParts<std::uint32_t>;

LinkRowsBuilder::LinkRowsBuilder(std::size_t rows, std::size_t columns)
    : is_narrow_(columns <= LinkRows::most_narrow),
      shift_(shift_for(rows)),
      narrow_(is_narrow_ ? rows : 0, shift_),
      wide_(is_narrow_ ? 0 : rows, shift_) {}

LinkRows LinkRowsBuilder::finish() {
  return {shift_, narrow_.finish(), wide_.finish()};
}

}  // namespace sunfleck
