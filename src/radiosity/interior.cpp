#include <sunfleck/radiosity/interior.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/projection.hpp>

namespace sunfleck {

namespace {
constexpr std::uint64_t interior_stream = 0x7f4a7c159e3779b9ULL;
}

std::vector<bool> interior_sides(const Elements& e, double pitch, std::uint64_t seed, Progress& progress) {
  constexpr std::uint32_t directions = 16;
  const double reach = std::sqrt(e.patch_area);
  std::uint32_t patches = 0;
  for (const auto o : e.patch_of_row) patches = std::max(patches, o + 1);
  std::vector<std::atomic<std::uint32_t>> all(2 * patches), inside(2 * patches), own(2 * patches);
  tbb::enumerable_thread_specific<LineBundle> bundles;
  tbb::parallel_for(std::uint32_t{0}, directions, [&](std::uint32_t d) {
    if (progress.cancelled()) return;
    LineBundle& bundle = bundles.local();
    const Vec3 direction = hemisphere_direction(d, directions, mix(seed, interior_stream));
    trace_lines(e.surface, project_set_member(e.surface, direction, d, pitch, mix(seed, interior_stream, 1)), bundle, LinesKept::met);
    const auto patch_side = [&](std::uint32_t cell_side) { return 2 * e.patch_of_row[e.row_of_cell[cell_side >> 1]] + (cell_side & 1u); };
    for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
      const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
      if (begin == end) continue;
      all[patch_side(bundle.side[begin] ^ 1u)].fetch_add(1, std::memory_order_relaxed);
      all[patch_side(bundle.side[end - 1])].fetch_add(1, std::memory_order_relaxed);
      for (std::uint32_t k = begin + 1; k < end; ++k) {
        const auto low = patch_side(bundle.side[k - 1]), high = patch_side(bundle.side[k] ^ 1u);
        all[low].fetch_add(1, std::memory_order_relaxed);
        all[high].fetch_add(1, std::memory_order_relaxed);
        if (low == high) own[low].fetch_add(2, std::memory_order_relaxed);
        if (low == high || (bundle.depth[k] - bundle.depth[k - 1]) * bundle.depth_to_length < reach) {
          inside[low].fetch_add(1, std::memory_order_relaxed);
          inside[high].fetch_add(1, std::memory_order_relaxed);
        }
      }
    }
  });
  progress.check();
  std::vector<bool> interior(2 * patches, false);
  const auto share = [&](const auto& lines, std::size_t i) { return all[i] > 0 ? static_cast<double>(lines[i]) / all[i] : 0.0; };
  // the second rule spares leaves that lie low over the ground or on one another
  for (std::size_t i = 0; i < interior.size(); ++i)
    interior[i] = share(inside, i) >= 0.85 && share(own, i) >= 0.3 && share(inside, i ^ 1) < 0.7;
  if (std::find(interior.begin(), interior.end(), true) == interior.end()) return {};
  return interior;
}

std::vector<std::uint8_t> interior_of_cells(const Elements& e, const std::vector<bool>& interior) {
  std::vector<std::uint8_t> out(interior.empty() ? 0 : 2 * e.surface.cells());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = interior[2 * e.patch_of_row[e.row_of_cell[i / 2]] + i % 2];
  return out;
}

}  // namespace sunfleck
