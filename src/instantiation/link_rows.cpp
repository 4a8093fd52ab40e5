#include "instantiation/link_rows.hpp"

#include <algorithm>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t ranges_wanted = 16;  // each is one thread's work in a merge, and takes room for itself once more
constexpr unsigned widest_range = 16;      // bits
constexpr std::uint32_t most_count = 255;

/// What a merge of one range works in.
struct Room {
  std::vector<std::uint64_t> place, cursor;
  std::vector<std::uint32_t> raw, column;
  std::vector<std::uint8_t> count;

  std::size_t bytes() const { return bytes_of(place) + bytes_of(cursor) + bytes_of(raw) + bytes_of(column) + bytes_of(count); }

  void add(std::uint32_t c, std::uint32_t n) {
    for (; n > 0; n -= std::min(n, most_count)) {
      column.push_back(c);
      count.push_back(static_cast<std::uint8_t>(std::min(n, most_count)));
    }
  }
};

}  // namespace

std::size_t LinkRows::bytes() const {
  return bytes_of(start) + bytes_of(column) + bytes_of(count);
}

LinkRowsBuilder::LinkRowsBuilder(std::size_t rows) : rows_(rows), length_(rows, 0) {
  while (shift_ < widest_range && (rows >> shift_) >= ranges_wanted) ++shift_;
  ranges_.resize((rows >> shift_) + 1);
}

void LinkRowsBuilder::merge() {
  tbb::enumerable_thread_specific<Room> rooms;
  tbb::parallel_for(std::size_t{0}, ranges_.size(), [&](std::size_t r) {
    const std::size_t low = r << shift_, high = std::min(rows_, (r + 1) << shift_);
    if (low >= high) return;
    Room& room = rooms.local();
    room.place.assign(high - low + 1, 0);
    for (const auto& list : lists_)
      if (!list.start.empty())
        for (auto k = list.start[r]; k < list.start[r + 1]; ++k) ++room.place[list.row[k] + 1];
    for (std::size_t i = 0; i < high - low; ++i) room.place[i + 1] += room.place[i];
    if (room.place.back() == 0) return;
    room.raw.resize(room.place.back());
    room.cursor = room.place;
    for (const auto& list : lists_)
      if (!list.start.empty())
        for (auto k = list.start[r]; k < list.start[r + 1]; ++k) room.raw[room.cursor[list.row[k]]++] = list.column[k];
    room.column.clear();
    room.count.clear();
    Range& kept = ranges_[r];
    std::size_t old = 0;  // of `kept`
    for (std::size_t i = 0; i < high - low; ++i) {
      std::uint32_t *next = room.raw.data() + room.place[i], *const end = room.raw.data() + room.place[i + 1];
      std::sort(next, end);
      const std::size_t old_end = old + length_[low + i], before = room.column.size();
      while (old < old_end || next < end) {
        const std::uint32_t column = next == end ? kept.column[old] : old == old_end ? *next : std::min(*next, kept.column[old]);
        std::uint32_t n = 0;
        for (; old < old_end && kept.column[old] == column; ++old) n += kept.count[old];
        for (; next < end && *next == column; ++next) ++n;
        room.add(column, n);
      }
      length_[low + i] = static_cast<std::uint32_t>(room.column.size() - before);
    }
    kept = {};
    kept.column.assign(room.column.begin(), room.column.end());
    kept.count.assign(room.count.begin(), room.count.end());
  });
  std::size_t held = bytes_of(length_);
  for (const auto& room : rooms) held += room.bytes();
  for (const auto& range : ranges_) held += bytes_of(range.column) + bytes_of(range.count);
  for (const auto& list : lists_) held += bytes_of(list.start) + bytes_of(list.row) + bytes_of(list.column);
  peak_ = std::max(peak_, held);
  lists_ = {};
}

LinkRows LinkRowsBuilder::finish() {
  LinkRows out;
  out.start.assign(rows_ + 1, 0);
  for (std::size_t i = 0; i < rows_; ++i) out.start[i + 1] = out.start[i] + length_[i];
  length_ = {};
  out.column.reserve(out.start.back() + LinkRows::padding);
  for (auto& range : ranges_) {
    out.column.insert(out.column.end(), range.column.begin(), range.column.end());
    range.column = {};
  }
  out.column.insert(out.column.end(), LinkRows::padding, 0);
  out.count.reserve(out.start.back());
  for (auto& range : ranges_) {
    out.count.insert(out.count.end(), range.count.begin(), range.count.end());
    range.count = {};
  }
  return out;
}

}  // namespace sunfleck
