#include "line_links.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t line_stream = 0x9fb21c651e98df25ULL;

struct SidePair {
  std::uint32_t low, high;  ///< the lower fragment's upward side and the upper fragment's downward side
};

/// What one direction's lines say.
struct DirectionLines {
  std::vector<SidePair> pairs;
  std::vector<std::uint32_t> open_up, open_down;  ///< sides, once per line
  std::vector<std::pair<std::uint32_t, float>> outside_up, outside_down;
};

void collect(const Elements& e, const LineBundle& bundle, const std::vector<OutsideArea>& outside, DirectionLines& out) {
  const auto side_of = [&](std::uint32_t cell_side) { return 2 * e.element_of_cell[cell_side >> 1] + (cell_side & 1u); };
  out.pairs.reserve(bundle.side.size());
  for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
    const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
    if (begin == end) continue;
    std::uint32_t up = side_of(bundle.side[begin]);
    out.open_down.push_back(up ^ 1u);
    for (std::uint32_t k = begin + 1; k < end; ++k) {
      const std::uint32_t next = side_of(bundle.side[k]);
      out.pairs.push_back({up, next ^ 1u});
      up = next;
    }
    out.open_up.push_back(up);
  }
  for (const auto& o : outside) {
    const std::uint32_t up = 2 * e.element_of_cell[o.cell] + (o.front_up ? 0 : 1);
    out.outside_up.emplace_back(up, o.lines);
    out.outside_down.emplace_back(up ^ 1u, o.lines);
  }
}

}  // namespace

std::size_t LineLinks::bytes() const {
  return bytes_of(start) + bytes_of(column) + bytes_of(count) + bytes_of(lines) + bytes_of(open_up) + bytes_of(open_down);
}

LineLinks line_links(const Elements& e, const RadiositySettings& settings, Progress& progress) {
  const std::uint32_t directions = settings.density.directions;
  const std::size_t sides = 2 * e.size();
  const double pitch = std::sqrt(0.5 * e.element_area / settings.density.lines_per_element);
  std::vector<DirectionLines> found(directions);
  tbb::parallel_for(std::uint32_t{0}, directions, [&](std::uint32_t d) {
    if (progress.cancelled()) return;
    thread_local LineBundle bundle;
    const Vec3 direction = hemisphere_direction(d, directions, mix(settings.seed, line_stream));
    const auto p = project_set_member(e.surface, direction, d, pitch, mix(settings.seed, line_stream, 1));
    trace_lines(e.surface, p, bundle);
    collect(e, bundle, outside_focus(e.surface, p), found[d]);
  });
  progress.check();

  LineLinks links;
  links.open_up.assign(sides, 0.0f);
  links.open_down.assign(sides, 0.0f);
  links.lines.assign(sides, 0.0f);
  std::vector<std::uint32_t> start(sides + 1, 0);
  for (const auto& f : found) {
    links.fragments += f.pairs.size() + f.open_up.size();
    for (const auto& p : f.pairs) {
      ++start[p.low + 1];
      ++start[p.high + 1];
    }
    for (const auto s : f.open_up) links.open_up[s] += 1.0f;
    for (const auto s : f.open_down) links.open_down[s] += 1.0f;
  }
  for (const auto& f : found) {
    for (const auto& [s, lines] : f.outside_up) links.open_up[s] += lines;
    for (const auto& [s, lines] : f.outside_down) links.open_down[s] += lines;
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
