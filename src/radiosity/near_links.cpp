#include "near_links.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>

namespace sunfleck {

namespace {

constexpr int most_column_bits = 28;
constexpr int most_block_bits = 11;  ///< the lines of a block are sorted within a processor's cache
constexpr int digit_bits = 11;
constexpr std::size_t largest_piece = 65535;  ///< rows begin at 16 bits

/// Sorts by the lowest `bits` bits, digit by digit; `other` is scratch space.
void radix_sort(std::vector<std::uint32_t>& values, std::vector<std::uint32_t>& other, int bits) {
  other.resize(values.size());
  for (int shift = 0; shift < bits; shift += digit_bits) {
    std::array<std::uint32_t, std::size_t{1} << digit_bits> place{};
    for (const auto v : values) ++place[v >> shift & ((1u << digit_bits) - 1)];
    std::uint32_t sum = 0;
    for (auto& p : place) {
      const auto n = p;
      p = sum;
      sum += n;
    }
    for (const auto v : values) other[place[v >> shift & ((1u << digit_bits) - 1)]++] = v;
    values.swap(other);
  }
}

/// Values [first, first + Columns) of n.
template <std::size_t Columns>
void sum_columns(const NearLinks& links, const float* values, std::size_t n, std::size_t first, float* out, std::size_t begin,
                 std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    float sum[Columns] = {};
    links.for_row(i, [&](std::uint32_t column, std::uint32_t lines) {
      const float* from = values + std::size_t{column} * n + first;
      const auto count = static_cast<float>(lines);
      for (std::size_t c = 0; c < Columns; ++c) sum[c] += count * from[c];
    });
    float* to = out + i * n + first;
    for (std::size_t c = 0; c < Columns; ++c) to[c] = sum[c];
  }
}

}  // namespace

void weighted_sums(const NearLinks& links, const float* values, std::size_t n, float* out, std::size_t begin, std::size_t end) {
  std::size_t c = 0;
  for (; c + 16 <= n; c += 16) sum_columns<16>(links, values, n, c, out, begin, end);
  for (; c + 4 <= n; c += 4) sum_columns<4>(links, values, n, c, out, begin, end);
  switch (n - c) {
    case 1:
      return sum_columns<1>(links, values, n, c, out, begin, end);
    case 2:
      return sum_columns<2>(links, values, n, c, out, begin, end);
    case 3:
      return sum_columns<3>(links, values, n, c, out, begin, end);
    default:
      return;
  }
}

std::size_t NearLinks::size() const {
  std::size_t n = 0;
  for (const auto& block : blocks_)
    for (const auto& piece : block) n += piece.used;
  return n;
}

std::size_t NearLinks::bytes() const {
  std::size_t n = bytes_of(at_);
  for (const auto& block : blocks_)
    for (const auto& piece : block) n += piece.size * sizeof(std::uint32_t) + sizeof(Piece);
  return n;
}

NearBuilder::NearBuilder(std::size_t most_sides)
    : block_bits_(0),
      column_bits_(std::max(1, static_cast<int>(std::bit_width(std::max<std::size_t>(most_sides, 1) - 1)))),
      block_mask_(0) {
  if (column_bits_ > most_column_bits)
    throw Error(fmt::format("{} sides of elements are too many to link: at most {}", most_sides, std::size_t{1} << most_column_bits));
  block_bits_ = std::min(32 - column_bits_, most_block_bits);
  block_mask_ = (1u << block_bits_) - 1;
  waiting_.resize((most_sides >> block_bits_) + 1);
}

void NearBuilder::grow(Waiting& w, std::size_t least) {
  const std::size_t size = std::max(least, std::clamp<std::size_t>(w.size / 8, 128, largest_piece));
  w.pieces.push_back({std::make_unique_for_overwrite<std::uint32_t[]>(size), static_cast<std::uint32_t>(size), 0});
  w.size += size;
  w.at = w.pieces.back().links.get();
  w.end = w.at + size;
}

NearLinks NearBuilder::finish(std::size_t rows, std::vector<float>& lines) {
  NearLinks links;
  links.block_bits_ = block_bits_;
  links.column_bits_ = column_bits_;
  const std::size_t in_block = std::size_t{1} << block_bits_, blocks = (rows + in_block - 1) >> block_bits_;
  links.blocks_.resize(blocks);
  links.at_.resize(rows);
  tbb::enumerable_thread_specific<std::array<std::vector<std::uint32_t>, 2>> scratch;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    auto& [ends, other] = scratch.local();
    Waiting& w = waiting_[b];
    ends.clear();
    for (auto& piece : w.pieces) {
      const std::uint32_t* begin = piece.links.get();
      ends.insert(ends.end(), begin, &piece == &w.pieces.back() ? w.at : begin + piece.size);
    }
    radix_sort(ends, other, block_bits_ + column_bits_);
    if (w.pieces.empty()) grow(w);
    const std::uint32_t column_mask = (1u << column_bits_) - 1;
    const std::size_t most = std::size_t{1} << (32 - column_bits_);
    std::size_t k = 0, p = 0;
    for (std::size_t row = b << block_bits_, end_row = std::min(rows, row + in_block), r = 0; row < end_row; ++row, ++r) {
      // equal ends become one link, in place
      const std::size_t begin = k;
      std::size_t out = begin;
      while (k < ends.size() && ends[k] >> column_bits_ == r) {
        std::size_t last = k + 1;
        while (last < ends.size() && ends[last] == ends[k] && last - k < most) ++last;
        ends[out++] = (ends[k] & column_mask) | static_cast<std::uint32_t>(last - k - 1) << column_bits_;
        k = last;
      }
      lines[row] += static_cast<float>(k - begin);
      const std::size_t size = out - begin;
      while (w.pieces[p].size - w.pieces[p].used < size || w.pieces[p].used > largest_piece)
        if (++p == w.pieces.size()) grow(w, size);
      auto& piece = w.pieces[p];
      links.at_[row] = static_cast<std::uint32_t>(p) << 16 | piece.used;
      std::copy_n(ends.data() + begin, size, piece.links.get() + piece.used);
      piece.used += static_cast<std::uint32_t>(size);
    }
    w.pieces.resize(p + 1);
    links.blocks_[b] = std::move(w.pieces);
    w = {};
  });
  return links;
}

}  // namespace sunfleck
