#include "line_collector.hpp"

#include <algorithm>
#include <cmath>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {
constexpr std::uint64_t interior_stream = 0x7f4a7c159e3779b9ULL;
}

std::vector<bool> interior_sides(const Elements& e, double pitch, std::uint64_t seed, Progress& progress) {
  constexpr std::uint32_t directions = 16;
  const double reach = std::sqrt(e.organ_area);
  std::uint32_t organs = 0;
  for (const auto o : e.organ_of_row) organs = std::max(organs, o + 1);
  std::vector<std::atomic<std::uint32_t>> all(2 * organs), inside(2 * organs), own(2 * organs);
  tbb::enumerable_thread_specific<LineBundle> bundles;
  tbb::parallel_for(std::uint32_t{0}, directions, [&](std::uint32_t d) {
    if (progress.cancelled()) return;
    LineBundle& bundle = bundles.local();
    const Vec3 direction = hemisphere_direction(d, directions, mix(seed, interior_stream));
    trace_lines(e.surface, project_set_member(e.surface, direction, d, pitch, mix(seed, interior_stream, 1)), bundle);
    const auto organ_side = [&](std::uint32_t cell_side) { return 2 * e.organ_of_row[e.row_of_cell[cell_side >> 1]] + (cell_side & 1u); };
    for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
      const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
      if (begin == end) continue;
      all[organ_side(bundle.side[begin] ^ 1u)].fetch_add(1, std::memory_order_relaxed);
      all[organ_side(bundle.side[end - 1])].fetch_add(1, std::memory_order_relaxed);
      for (std::uint32_t k = begin + 1; k < end; ++k) {
        const auto low = organ_side(bundle.side[k - 1]), high = organ_side(bundle.side[k] ^ 1u);
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
  std::vector<bool> interior(2 * organs, false);
  const auto share = [&](const auto& lines, std::size_t i) { return all[i] > 0 ? static_cast<double>(lines[i]) / all[i] : 0.0; };
  // the second rule spares leaves that lie low over the ground or on one another
  for (std::size_t i = 0; i < interior.size(); ++i)
    interior[i] = share(inside, i) >= 0.85 && share(own, i) >= 0.3 && share(inside, i ^ 1) < 0.7;
  if (std::find(interior.begin(), interior.end(), true) == interior.end()) return {};
  return interior;
}

LineCollector::LineCollector(const Elements& elements, const ClusterTree* tree, double link_error, const std::vector<bool>& interior)
    : e_(elements), tree_(tree), link_error_(static_cast<float>(link_error)) {
  if (interior.empty()) return;
  interior_.resize(2 * e_.surface.cells());
  for (std::size_t i = 0; i < interior_.size(); ++i) interior_[i] = interior[2 * e_.organ_of_row[e_.row_of_cell[i / 2]] + i % 2];
  inside_ = std::vector<std::atomic<std::uint32_t>>(e_.surface.cells());
}

void LineCollector::collect(LineBundle& bundle, DirectionLines& out) {
  const std::size_t n = bundle.side.size();
  out.cell_side.swap(bundle.side);
  out.side.resize(n);
  out.link.resize(n);
  out.far.clear();
  for (std::size_t k = 0; k < n; ++k) out.side[k] = 2 * e_.element_of_cell[out.cell_side[k] >> 1] + (out.cell_side[k] & 1u);
  FarPair far;
  for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
    const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
    if (begin == end) continue;
    if (!interior_.empty()) mark_enclosed(out.cell_side.data() + begin, end - begin, out.side.data() + begin);
    out.link[begin] = HitLink::lowest;
    for (std::uint32_t k = begin + 1; k < end; ++k) {
      out.link[k] = HitLink::near;
      if (!tree_) continue;
      const double distance = (bundle.depth[k] - bundle.depth[k - 1]) * bundle.depth_to_length;
      if (!cluster_link(out.side[k - 1], out.side[k] ^ 1u, distance, far)) continue;
      out.link[k] = HitLink::far;
      out.far.push_back(far);
    }
  }
}

bool LineCollector::cluster_link(std::uint32_t low, std::uint32_t high, double distance, FarPair& pair) const {
  if ((low | high) & enclosed_bit) return false;
  const auto& t = *tree_;
  std::uint32_t a = t.cluster_of_element[low >> 1], b = t.cluster_of_element[high >> 1];
  if (a == b) return false;
  const float limit = link_error_ * static_cast<float>(distance);
  const auto allowed = [&](std::uint32_t x, std::uint32_t y) {
    return std::max(t.albedo[x], t.albedo[y]) * (t.diameter[x] + t.diameter[y]) <= limit;
  };
  if (!allowed(a, b)) return false;
  for (;;) {  // climb with the smaller of the two
    const auto up_a = t.parent[a], up_b = t.parent[b];
    if (up_a == ClusterTree::none || up_b == ClusterTree::none || up_a == up_b) break;
    if (t.diameter[a] <= t.diameter[b] && allowed(up_a, b))
      a = up_a;
    else if (allowed(a, up_b))
      b = up_b;
    else if (allowed(up_a, b))
      a = up_a;
    else
      break;
  }
  pair = {low, high, a, b};
  return true;
}

/// A hit is enclosed if one of its sides, not being an interior side itself, faces an interior side.
void LineCollector::mark_enclosed(const std::uint32_t* hit, std::uint32_t n, std::uint32_t* side) {
  const auto enclose = [&](std::uint32_t k) {
    if (side[k] & enclosed_bit) return;
    side[k] |= enclosed_bit;
    inside_[hit[k] >> 1].fetch_add(1, std::memory_order_relaxed);
  };
  for (std::uint32_t k = 1; k < n; ++k) {
    const bool low = interior_[hit[k - 1]] != 0, high = interior_[hit[k] ^ 1u] != 0;
    if (low && !high) enclose(k);
    if (high && !low) enclose(k - 1);
  }
}

}  // namespace sunfleck
