#include <algorithm>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "rasterise.hpp"

namespace sunfleck {

namespace {

using Fragment = LineBundle::Fragment;

/// So many fragments of one line are told apart where they coincide.
constexpr std::ptrdiff_t most_coincident = 256;

/// Is b above a, where the two coincide? For facets i < j, j lies on the front side of i; images of one facet stay as they are.
bool coincident_above(const Fragment& b, const Fragment& a) {
  if ((b.facet >> 1) == (a.facet >> 1)) return false;
  const bool later = (b.facet >> 1) > (a.facet >> 1);
  return later == (((later ? a : b).facet & 1u) != 0);
}

/// Lines that meet nothing and still have a place of their own.
constexpr std::size_t most_empty_lines = std::size_t{1} << 24;
constexpr std::size_t most_lines = std::size_t{1} << 32;

/// By counting: lines that meet nothing have a place too.
void sort_dense(std::size_t pixels, LineBundle& bundle) {
  auto& start = bundle.start;
  start.assign(pixels + 2, 0);
  for (const auto& f : bundle.found) ++start[f.pixel + 2];
  for (std::size_t q = 2; q < pixels + 2; ++q) start[q] += start[q - 1];
  bundle.sorted.resize(bundle.found.size());
  for (const auto& f : bundle.found) bundle.sorted[start[f.pixel + 1]++] = f;  // start[q + 1] runs from the begin of q to its end
  start.pop_back();
}

/// Where nearly all lines meet nothing, as between plants that stand far apart.
void sort_sparse(LineBundle& bundle) {
  bundle.sorted = bundle.found;
  std::stable_sort(bundle.sorted.begin(), bundle.sorted.end(), [](const Fragment& a, const Fragment& b) { return a.pixel < b.pixel; });
  bundle.start.assign(1, 0);
  for (std::size_t k = 1; k <= bundle.sorted.size(); ++k)
    if (k == bundle.sorted.size() || bundle.sorted[k].pixel != bundle.sorted[k - 1].pixel)
      bundle.start.push_back(static_cast<std::uint32_t>(k));
}

}  // namespace

void trace_lines(const Surface& surface, const Projection& p, LineBundle& bundle, LinesKept lines) {
  auto &found = bundle.found, &sorted = bundle.sorted;
  found.clear();
  const std::size_t pixels = static_cast<std::size_t>(p.columns) * static_cast<std::size_t>(p.rows);
  if (pixels > most_lines)
    throw InputError("scene",
                     fmt::format("{:.3g} lines along one direction, from end to end of what stands far apart", static_cast<double>(pixels)),
                     fmt::format("at most {:.3g}: method instantiation, which draws lines within plants only, or scenes of their own",
                                 static_cast<double>(most_lines)));
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
  if (lines == LinesKept::met && pixels > most_empty_lines + 4 * found.size())
    sort_sparse(bundle);
  else
    sort_dense(pixels, bundle);
  const auto tolerance = static_cast<float>(surface.depth_tolerance * depth_per_length(surface, p));
  const auto above = [](const Fragment& a, const Fragment& b) { return a.depth < b.depth || (a.depth == b.depth && a.facet < b.facet); };
  for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
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
      for (Fragment* j = i; j != begin && i - j < most_coincident && j->depth - j[-1].depth <= tolerance && coincident_above(j[-1], *j);
           --j)
        std::swap(*j, j[-1]);
  }
  bundle.side.resize(sorted.size());
  bundle.depth.resize(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    bundle.side[i] = 2 * sorted[i].cell + (sorted[i].facet & 1u ? 0u : 1u);
    bundle.depth[i] = sorted[i].depth;
  }
  bundle.depth_to_length = 1.0 / depth_per_length(surface, p);
}

}  // namespace sunfleck
