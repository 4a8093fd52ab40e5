#include <algorithm>

#include <sunfleck/visibility/projection.hpp>

#include "rasterise.hpp"

namespace sunfleck {

namespace {

using Fragment = LineBundle::Fragment;

/// Is b above a, where the two coincide? For facets i < j, j lies on the front side of i.
bool coincident_above(const Fragment& b, const Fragment& a) {
  const bool later = (b.facet >> 1) > (a.facet >> 1);
  return later == (((later ? a : b).facet & 1u) != 0);
}

}  // namespace

void trace_lines(const Surface& surface, const Projection& p, LineBundle& bundle) {
  auto &found = bundle.found, &sorted = bundle.sorted;
  found.clear();
  rasterise(surface, p, nullptr, 0, surface.size(), 0, p.rows,
            [&](const ProjectedTriangle& t, int row, int column, int count, float dx, float dy) {
              const std::uint32_t base = surface.first_cell[t.index], facet = 2 * t.index + (t.front_up ? 1u : 0u);
              const auto pixel =
                  static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(p.columns) + static_cast<std::uint32_t>(column);
              for (int i = 0; i < count; ++i) {
                const float x = dx + static_cast<float>(i);
                const std::uint32_t cell = t.split == 1 ? base : base + cell_of(t.u.at(x, dy), t.v.at(x, dy), t.split);
                found.push_back({pixel + static_cast<std::uint32_t>(i), facet, cell, t.depth_at(x, dy)});
              }
            });
  const std::size_t pixels = static_cast<std::size_t>(p.columns) * p.rows;
  bundle.start.assign(pixels + 2, 0);
  for (const auto& f : found) ++bundle.start[f.pixel + 2];
  for (std::size_t q = 2; q < pixels + 2; ++q) bundle.start[q] += bundle.start[q - 1];
  sorted.resize(found.size());
  for (const auto& f : found) sorted[bundle.start[f.pixel + 1]++] = f;  // start[q + 1] runs from the begin of q to its end
  bundle.start.pop_back();
  const auto tolerance = static_cast<float>(surface.depth_tolerance * (p.wraps ? p.direction.z : 1.0));
  const auto above = [](const Fragment& a, const Fragment& b) { return a.depth < b.depth || (a.depth == b.depth && a.facet < b.facet); };
  for (std::size_t q = 0; q < pixels; ++q) {
    Fragment* begin = sorted.data() + bundle.start[q];
    Fragment* end = sorted.data() + bundle.start[q + 1];
    if (end - begin < 2) continue;
    if (end - begin <= 24)
      for (Fragment* i = begin + 1; i != end; ++i) {
        const Fragment f = *i;
        Fragment* j = i;
        for (; j != begin && above(f, j[-1]); --j) *j = j[-1];
        *j = f;
      }
    else
      std::sort(begin, end, above);
    for (Fragment* i = begin + 1; i != end; ++i)
      for (Fragment* j = i; j != begin && j->depth - j[-1].depth <= tolerance && coincident_above(j[-1], *j); --j) std::swap(*j, j[-1]);
  }
  bundle.side.resize(sorted.size());
  bundle.depth.resize(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    bundle.side[i] = 2 * sorted[i].cell + (sorted[i].facet & 1u ? 0u : 1u);
    bundle.depth[i] = sorted[i].depth;
  }
  bundle.depth_to_length = p.wraps ? 1.0 / p.direction.z : 1.0;
}

}  // namespace sunfleck
