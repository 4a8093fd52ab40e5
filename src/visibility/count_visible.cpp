#include <algorithm>
#include <cmath>

#include <sunfleck/visibility/projection.hpp>

#include "depth_buffer.hpp"
#include "rasterise.hpp"

namespace sunfleck {

namespace {

/// Triangles whose rows meet each strip, in rising order.
struct StripLists {
  std::vector<std::uint32_t> start, triangle;
};

StripLists strips_of(const Surface& s, const Projection& p, int strip_rows, int strips) {
  StripLists lists;
  std::vector<std::pair<int, int>> range(s.size(), {0, -1});
  std::vector<std::uint32_t> count(strips + 1, 0);
  const auto visit = [&](std::size_t t, auto&& call) {
    const auto [low, high] = range[t];
    if (high < low) return;
    if (!p.wraps) {
      for (int i = std::max(0, low / strip_rows), last = std::min(strips - 1, high / strip_rows); i <= last; ++i) call(i);
      return;
    }
    if (high - low + 1 >= p.rows) {
      for (int i = 0; i < strips; ++i) call(i);
      return;
    }
    const auto wrap = [&](int y) { return ((y % p.rows) + p.rows) % p.rows; };
    const int a = wrap(low) / strip_rows, b = wrap(high) / strip_rows;
    if (wrap(low) <= wrap(high))
      for (int i = a; i <= b; ++i) call(i);
    else
      for (int i = 0; i < strips; ++i)
        if (i >= a || i <= b) call(i);
  };
  for (std::size_t t = 0; t < s.size(); ++t) {
    if (s.split[t] == 0) continue;
    float low = 1e30f, high = -1e30f;
    for (int k = 0; k < 3; ++k) {
      const double y = p.y_row.x * s.corner[3 * k][t] + p.y_row.y * s.corner[3 * k + 1][t] + p.y_row.z * s.corner[3 * k + 2][t] + p.y0;
      low = std::min(low, static_cast<float>(y));
      high = std::max(high, static_cast<float>(y));
    }
    range[t] = {static_cast<int>(std::floor(low - 1.0f)), static_cast<int>(std::ceil(high))};
    if (!p.wraps && (range[t].second < 0 || range[t].first >= p.rows)) range[t] = {0, -1};
    if (!p.wraps) range[t].first = std::max(0, range[t].first);
    visit(t, [&](int i) { ++count[i + 1]; });
  }
  for (int i = 0; i < strips; ++i) count[i + 1] += count[i];
  lists.start = count;
  lists.triangle.resize(count[strips]);
  for (std::size_t t = 0; t < s.size(); ++t) visit(t, [&](int i) { lists.triangle[count[i]++] = static_cast<std::uint32_t>(t); });
  return lists;
}

void count_strip(const Surface& s, const Projection& p, bool from_below, const std::uint32_t* list, std::size_t triangles, int row_begin,
                 int row_end, DepthBuffer& buffer, VisibleCounts& counts) {
  const std::size_t pixels = static_cast<std::size_t>(row_end - row_begin) * p.columns;
  buffer.clear(pixels);
  const float sign = from_below ? -1.0f : 1.0f;
  const auto tolerance = static_cast<float>(s.depth_tolerance * depth_per_length(s, p));
  rasterise(s, p, list, 0, triangles, row_begin, row_end,
            [&](const ProjectedTriangle& t, int row, int column, int count, float dx, float dy) {
              const std::size_t first = static_cast<std::size_t>(row - row_begin) * p.columns + column;
              draw_span(t, s.first_cell[t.index], t.front_up != from_below ? 1u : 0u, sign, 0.0f, count, dx, dy, tolerance,
                        buffer.depth.data() + first, buffer.code.data() + first,
                        [&](std::uint32_t cell, int fragments) { counts.all[cell] += static_cast<float>(fragments); });
            });
  for (std::size_t q = 0; q < pixels;) {
    const std::uint32_t code = buffer.code[q];
    std::size_t end = q + 1;
    while (end < pixels && buffer.code[end] == code) ++end;
    if (code != nothing) counts.visible[code >> 1] += static_cast<float>(end - q);
    q = end;
  }
}

}  // namespace

void count_visible(const Surface& surface, const Projection& projection, bool from_below, VisibleCounts& counts) {
  constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
  thread_local DepthBuffer buffer;
  const auto fitting = buffer_bytes / (8 * static_cast<std::size_t>(projection.columns));
  const int strip_rows = static_cast<int>(std::clamp<std::size_t>(fitting, 16, static_cast<std::size_t>(std::max(16, projection.rows))));
  const int strips = (projection.rows + strip_rows - 1) / strip_rows;
  if (strips == 1) {
    count_strip(surface, projection, from_below, nullptr, surface.size(), 0, projection.rows, buffer, counts);
  } else {
    const StripLists lists = strips_of(surface, projection, strip_rows, strips);
    for (int i = 0; i < strips; ++i)
      if (lists.start[i] < lists.start[i + 1])  // else there is nothing to see
        count_strip(surface, projection, from_below, lists.triangle.data() + lists.start[i], lists.start[i + 1] - lists.start[i],
                    i * strip_rows, std::min(projection.rows, (i + 1) * strip_rows), buffer, counts);
  }
  for (const auto& o : outside_focus(surface, projection)) {
    counts.all[o.cell] += o.lines;
    counts.visible[o.cell] += o.lines;
  }
}

}  // namespace sunfleck
