// Which facets a picture needs, so that only their values are read and held.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunfleck {

/// A bit for each facet of the scene, and after close() a dense row for each bit that is set: 0.2 bytes a facet in all. A scene whose
/// values all fit is taken as seen, which saves the rays that would find out.
class SeenFacets {
 public:
  /// `bytes`: of a facet's values.
  SeenFacets(std::size_t facets, std::size_t bytes, std::size_t most_bytes = std::size_t{1} << 28)
      : facets_(facets), all_(facets <= most_bytes / bytes), words_(all_ ? 0 : (facets + 63) / 64) {}

  /// No need to add anything.
  bool all() const { return all_; }
  bool has(std::size_t facet) const { return all_ || (words_[facet / 64].load(std::memory_order_relaxed) >> (facet % 64)) & 1; }
  /// From any thread.
  void add(std::size_t facet) {
    if (!all_ && !has(facet)) words_[facet / 64].fetch_or(std::uint64_t{1} << (facet % 64), std::memory_order_relaxed);
  }
  void add(std::size_t first, std::size_t count) {
    for (std::size_t f = first; f < first + count; ++f) add(f);
  }

  /// Numbers the rows; nothing may be added after it.
  void close() {
    rank_.resize(words_.size() + 1);
    for (std::size_t w = 0; w < words_.size(); ++w) rank_[w + 1] = rank_[w] + static_cast<std::uint32_t>(std::popcount(words_[w].load()));
  }
  std::size_t count() const { return all_ ? facets_ : rank_.back(); }
  std::size_t row(std::size_t facet) const {
    return all_ ? facet
                : rank_[facet / 64] + static_cast<std::size_t>(std::popcount(words_[facet / 64].load(std::memory_order_relaxed) &
                                                                             ((std::uint64_t{1} << (facet % 64)) - 1)));
  }
  bool any(std::size_t first, std::size_t count) const {
    if (all_) return true;
    for (std::size_t f = first; f < first + count; ++f) {
      if (f % 64 == 0 && f + 64 <= first + count) {
        if (words_[f / 64].load(std::memory_order_relaxed) != 0) return true;
        f += 63;
      } else if (has(f)) {
        return true;
      }
    }
    return false;
  }

 private:
  std::size_t facets_;
  bool all_;
  std::vector<std::atomic<std::uint64_t>> words_;
  std::vector<std::uint32_t> rank_;
};

}  // namespace sunfleck
