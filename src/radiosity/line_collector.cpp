#include "line_collector.hpp"

#include <sunfleck/radiosity/interior.hpp>

namespace sunfleck {

LineCollector::LineCollector(const Elements& elements, const ClusterTree* tree, double link_error, const std::vector<bool>& interior,
                             const GroundContact& contact)
    : e_(elements), tree_(tree), link_error_(static_cast<float>(link_error)), contact_(contact) {
  if (interior.empty() && !contact.any()) return;
  interior_ = interior_of_cells(elements, interior);
  inside_ = std::vector<std::atomic<std::uint32_t>>(e_.surface.cells());
}

void LineCollector::collect(LineBundle& bundle, const Vec3& direction, DirectionLines& out) {
  const std::size_t n = bundle.side.size();
  out.side.resize(n);
  out.link.resize(n);
  out.far.clear();
  for (std::size_t k = 0; k < n; ++k) out.side[k] = 2 * e_.element_of_cell[bundle.side[k] >> 1] + (bundle.side[k] & 1u);
  FarPair far;
  for (std::size_t q = 0; q + 1 < bundle.start.size(); ++q) {
    const std::uint32_t begin = bundle.start[q], end = bundle.start[q + 1];
    if (begin == end) continue;
    const auto enclose = [&](std::uint32_t k) { mark_enclosed(bundle.side[k] >> 1, out.side[k]); };
    if (!interior_.empty()) each_enclosed(interior_, bundle.side.data() + begin, end - begin, [&](std::uint32_t k) { enclose(begin + k); });
    if (contact_.any()) contact_.each_covered(bundle, direction, begin, end, enclose);
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
  out.cell_side.swap(bundle.side);
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

void LineCollector::mark_enclosed(std::uint32_t cell, std::uint32_t& side) {
  if (side & enclosed_bit) return;
  side |= enclosed_bit;
  inside_[cell].fetch_add(1, std::memory_order_relaxed);
}

}  // namespace sunfleck
