// Rows of links, made of entries that come in lists.
#include <catch2/catch.hpp>

#include <map>
#include <utility>

#include <sunfleck/core/sampling.hpp>

#include "instantiation/link_rows.hpp"

using namespace sunfleck;

namespace {

using Entries = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Entries random_entries(std::size_t number, std::uint32_t rows, std::uint32_t columns) {
  RandomStream random(11);
  Entries out;
  for (std::size_t i = 0; i < number; ++i)
    out.emplace_back(static_cast<std::uint32_t>(random.next() * rows), static_cast<std::uint32_t>(random.next() * columns));
  for (int i = 0; i < 600; ++i) out.emplace_back(rows - 1, columns - 1);  // more than one entry can count
  return out;
}

/// In so many turns of so many lists each, every other of which ends in a merge.
LinkRows made(const Entries& entries, std::size_t rows, std::size_t columns, std::size_t merges, std::size_t lists) {
  LinkRowsBuilder builder(rows, columns);
  const auto part = [&](std::size_t i, std::size_t n) { return entries.size() * i / n; };
  for (std::size_t m = 0; m < merges; ++m) {
    const std::size_t first = builder.begin(lists);
    for (std::size_t l = 0; l < lists; ++l)
      builder.put(first + l, [&](auto&& call) {
        for (auto k = part(m * lists + l, merges * lists); k < part(m * lists + l + 1, merges * lists); ++k)
          call(entries[k].first, entries[k].second);
      });
    if ((merges - m) % 2 == 1) builder.merge();
  }
  return builder.finish();
}

}  // namespace

TEST_CASE("link rows count every entry, however they are shared out to lists and merges") {
  struct Shape {
    std::uint32_t rows, columns;
    bool narrow;
  };
  for (const auto [rows, columns, narrow] : {Shape{1, 3, true}, Shape{37, 50, true}, Shape{5000, 65536, true}, Shape{5000, 65537, false}}) {
    const auto entries = random_entries(40'000, rows, columns);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> expected;
    for (const auto& e : entries) ++expected[e];
    const auto once = made(entries, rows, columns, 1, 1);
    CHECK(once.narrow.empty() != narrow);
    std::size_t wrong = 0, links = 0;
    for (std::uint32_t r = 0; r < rows; ++r)
      once.row(r, [&](const auto* column, const std::uint8_t* count, std::size_t n) {
        for (std::size_t k = 0; k < n; ++k) {
          ++links;
          if (k > 0 && column[k] < column[k - 1]) ++wrong;
          expected[{r, column[k]}] -= count[k];
        }
      });
    CHECK(wrong == 0);
    CHECK(links == once.size());
    for (const auto& [place, left] : expected) wrong += left != 0;
    CHECK(wrong == 0);
    CHECK((made(entries, rows, columns, 1, 7) == once));
    CHECK((made(entries, rows, columns, 5, 3) == once));
  }
}

TEST_CASE("link rows are merged seldom enough that each is copied a few times only") {
  CHECK_FALSE(merge_is_due(999'999, 0));
  CHECK(merge_is_due(1'000'000, 0));
  CHECK_FALSE(merge_is_due(24'999'999, 100'000'000));
  CHECK(merge_is_due(25'000'000, 100'000'000));
  // lists of a million entries, as directions bring them, all of them links of their own
  std::uint64_t kept = 0, waiting = 0, copied = 0;
  while (kept < 1'000'000'000) {
    waiting += 1'000'000;
    if (!merge_is_due(waiting, kept)) continue;
    kept += waiting;
    copied += kept;
    waiting = 0;
  }
  CHECK(copied < 6 * kept);
}
