#include "line_links.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t line_stream = 0x9fb21c651e98df25ULL;

constexpr std::uint32_t enclosed_bit = 0x80000000u;

struct SidePair {
  std::uint32_t low, high;  ///< the lower fragment's upward side and the upper fragment's downward side
};

/// What one direction's lines say. Sides are 2 * element + side, with the enclosed bit.
struct DirectionLines {
  std::vector<SidePair> pairs;
  std::vector<std::uint32_t> open_up, open_down;  ///< sides, once per line
  std::vector<OutsideArea> outside;
};

class LineCollector {
 public:
  LineCollector(const Elements& elements, bool find_enclosed)
      : e_(elements), reach_(std::sqrt(elements.organ_area)), find_enclosed_(find_enclosed), met_(find_enclosed ? elements.surface.cells() : 0),
        inside_(met_.size()) {}

  void collect(const LineBundle& bundle, DirectionLines& out) {
    thread_local std::vector<std::uint32_t> side;
    out.pairs.reserve(bundle.side.size());
    for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
      const std::uint32_t begin = bundle.start[q], n = bundle.start[q + 1] - begin;
      if (n == 0) continue;
      side.resize(n);
      for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t cell_side = bundle.side[begin + k];
        side[k] = 2 * e_.element_of_cell[cell_side >> 1] + (cell_side & 1u);
      }
      if (find_enclosed_) mark_enclosed(bundle, begin, n, side.data());
      out.open_down.push_back(side[0] ^ 1u);
      for (std::uint32_t k = 1; k < n; ++k) out.pairs.push_back({side[k - 1], side[k] ^ 1u});
      out.open_up.push_back(side[n - 1]);
    }
  }

  /// Fraction of each cell that is enclosed; empty if none is.
  std::vector<float> enclosed() const {
    std::vector<float> fraction;
    for (std::size_t c = 0; c < inside_.size(); ++c)
      if (inside_[c] > 0) {
        if (fraction.empty()) fraction.assign(inside_.size(), 0.0f);
        fraction[c] = static_cast<float>(inside_[c]) / static_cast<float>(met_[c]);
      }
    return fraction;
  }

 private:
  std::uint32_t organ(std::uint32_t cell_side) const { return e_.organ_of_row[e_.row_of_cell[cell_side >> 1]]; }

  void mark_enclosed(const LineBundle& bundle, std::uint32_t begin, std::uint32_t n, std::uint32_t* side) {
    const std::uint32_t* hit = bundle.side.data() + begin;
    for (std::uint32_t k = 0; k < n; ++k) {
      met_[hit[k] >> 1].fetch_add(1, std::memory_order_relaxed);
      if (k == 0 || k + 1 == n) continue;
      const auto own = organ(hit[k]);
      std::uint32_t low = k, high = k;
      while (low > 0 && organ(hit[low]) == own) --low;
      while (high + 1 < n && organ(hit[high]) == own) ++high;
      const auto around = organ(hit[low]);
      const bool same_side = (hit[low] & 1u) == ((hit[high] & 1u) ^ 1u);
      if (around == own || around != organ(hit[high]) || !same_side ||
          (bundle.depth[begin + high] - bundle.depth[begin + low]) * bundle.depth_to_length > reach_)
        continue;
      side[k] |= enclosed_bit;
      inside_[hit[k] >> 1].fetch_add(1, std::memory_order_relaxed);
    }
  }

  const Elements& e_;
  const double reach_;  ///< no organ is thicker than this [m]
  const bool find_enclosed_;
  std::vector<std::atomic<std::uint32_t>> met_, inside_;  ///< [cells] lines; sums of integers do not depend on the order of work
};

}  // namespace

std::size_t LineLinks::bytes() const {
  return bytes_of(start) + bytes_of(column) + bytes_of(count) + bytes_of(lines) + bytes_of(open_up) + bytes_of(open_down) + bytes_of(whole) + bytes_of(enclosed_part) +
         bytes_of(enclosed);
}

LineLinks line_links(const Elements& e, const RadiositySettings& settings, Progress& progress) {
  const std::uint32_t directions = settings.density.directions;
  const double pitch = std::sqrt(0.5 * e.element_area / settings.density.lines_per_element);
  std::vector<DirectionLines> found(directions);
  LineCollector collector(e, settings.method != RadiosityMethod::flat);
  tbb::parallel_for(std::uint32_t{0}, directions, [&](std::uint32_t d) {
    if (progress.cancelled()) return;
    thread_local LineBundle bundle;
    const Vec3 direction = hemisphere_direction(d, directions, mix(settings.seed, line_stream));
    const auto p = project_set_member(e.surface, direction, d, pitch, mix(settings.seed, line_stream, 1));
    trace_lines(e.surface, p, bundle);
    collector.collect(bundle, found[d]);
    found[d].outside = outside_focus(e.surface, p);
  });
  progress.check();

  LineLinks links;
  links.whole.resize(e.size());
  std::iota(links.whole.begin(), links.whole.end(), 0u);
  links.enclosed = collector.enclosed();
  if (!links.enclosed.empty()) {
    links.enclosed_part.assign(e.size(), LineLinks::none);
    for (std::size_t c = 0; c < links.enclosed.size(); ++c) {
      auto& part = links.enclosed_part[e.element_of_cell[c]];
      if (links.enclosed[c] == 0.0f || part != LineLinks::none) continue;
      part = static_cast<std::uint32_t>(links.whole.size());
      links.whole.push_back(e.element_of_cell[c]);
    }
  }
  const std::size_t sides = 2 * links.whole.size();
  const auto part_side = [&](std::uint32_t side) {
    return side & enclosed_bit ? 2 * links.enclosed_part[(side & ~enclosed_bit) >> 1] + (side & 1u) : side;
  };
  links.open_up.assign(sides, 0.0f);
  links.open_down.assign(sides, 0.0f);
  links.lines.assign(sides, 0.0f);
  std::vector<std::uint32_t> start(sides + 1, 0);
  for (auto& f : found) {
    links.fragments += f.pairs.size() + f.open_up.size();
    for (auto& p : f.pairs) {
      p = {part_side(p.low), part_side(p.high)};
      ++start[p.low + 1];
      ++start[p.high + 1];
    }
    for (const auto s : f.open_up) links.open_up[part_side(s)] += 1.0f;
    for (const auto s : f.open_down) links.open_down[part_side(s)] += 1.0f;
    for (const auto& o : f.outside) {
      const std::uint32_t up = 2 * e.element_of_cell[o.cell] + (o.front_up ? 0 : 1);
      links.open_up[up] += o.lines;
      links.open_down[up ^ 1u] += o.lines;
    }
  }
  for (std::size_t i = 0; i < sides; ++i) start[i + 1] += start[i];
  std::vector<std::uint32_t> column(start[sides]);
  {
    std::vector<std::uint32_t> cursor(start.begin(), start.end() - 1);
    for (auto& f : found) {
      for (const auto& p : f.pairs) {
        column[cursor[p.low]++] = p.high;
        column[cursor[p.high]++] = p.low;
      }
      f = {};
    }
  }
  // merge equal columns
  std::vector<std::uint32_t> distinct(sides);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto begin = column.begin() + start[i], end = column.begin() + start[i + 1];
      std::sort(begin, end);
      std::uint32_t n = 0;
      for (auto k = begin; k != end; ++k) n += k == begin || *k != k[-1];
      distinct[i] = n;
      links.lines[i] = static_cast<float>(end - begin) + links.open_up[i] + links.open_down[i];
    }
  });
  links.start.assign(sides + 1, 0);
  for (std::size_t i = 0; i < sides; ++i) links.start[i + 1] = links.start[i] + distinct[i];
  links.column.resize(links.start[sides]);
  links.count.assign(links.start[sides], 0.0f);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      std::uint32_t out = links.start[i];
      for (std::uint32_t k = start[i]; k < start[i + 1]; ++k) {
        if (k > start[i] && column[k] != column[k - 1]) ++out;
        links.column[out] = column[k];
        links.count[out] += 1.0f;
      }
    }
  });
  return links;
}

}  // namespace sunfleck
