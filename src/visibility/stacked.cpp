#include "stacked.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double plane_tolerance = 4e-7;    // six times the spacing of floats at 1
constexpr double normal_tolerance = 1e-6;   // [rad]
constexpr double overlap_tolerance = 1e-7;  // neighbours that share an edge do not overlap

constexpr std::size_t most_pairs = 20'000'000;

using Vec2 = glm::dvec2;

struct Flat {
  Vec3 normal;
  double offset = 0, key = 0;
  std::uint32_t row = 0;
};

/// True if the triangles, both near the plane with the normal n, overlap by more than the tolerance (separating axes).
bool overlap(const Triangle& a, const Triangle& b, const Vec3& n) {
  for (const Triangle* t : {&a, &b})
    for (int i = 0; i < 3; ++i) {
      const Vec3 edge = (*t)[(i + 1) % 3] - (*t)[i];
      const double length = glm::length(edge);
      if (length == 0.0) continue;
      const Vec3 axis = glm::cross(n, edge) / length;
      double low_a = 1e300, high_a = -1e300, low_b = 1e300, high_b = -1e300;
      for (int k = 0; k < 3; ++k) {
        const double x = glm::dot(axis, a[k]), y = glm::dot(axis, b[k]);
        low_a = std::min(low_a, x), high_a = std::max(high_a, x), low_b = std::min(low_b, y), high_b = std::max(high_b, y);
      }
      if (std::min(high_a, high_b) - std::max(low_a, low_b) <= overlap_tolerance) return false;
    }
  return true;
}

class Finder {
 public:
  explicit Finder(std::span<const StackCandidate> candidates) : candidates_(candidates) {
    flats_.reserve(candidates.size());
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      const Vec3 n = upward_normal(candidates[i].corners);
      const double offset = glm::dot(n, candidates[i].corners[0]);
      // Equal planes have equal keys; unequal ones rarely have, whatever the canopy's symmetry.
      flats_.push_back({n, offset, 0.6180339887 * n.x + 0.2718281828 * n.y + 0.7320508076 * n.z + 0.4142135624 * offset, i});
    }
    std::sort(flats_.begin(), flats_.end(), [](const Flat& a, const Flat& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
  }

  std::vector<StackedPair> run() {
    // Bins of keys, each taken together with the next: what is nearer than a bin's width is in one of these.
    const auto bin = [](const Flat& f) { return std::floor(f.key / 4e-6); };
    for (std::size_t begin = 0; begin < flats_.size();) {
      const double first = bin(flats_[begin]);
      std::size_t next = begin, end = begin;
      while (end < flats_.size() && bin(flats_[end]) <= first + 1) {
        if (bin(flats_[end]) == first) next = end + 1;
        ++end;
      }
      const std::span<const Flat> run(flats_.data() + begin, end - begin);
      if (run.size() <= 64)
        for (std::size_t i = 0; i < run.size(); ++i)
          for (std::size_t j = i + 1; j < run.size(); ++j) test(run[i], run[j]);
      else
        grid(run);
      begin = next;
    }
    std::sort(pairs_.begin(), pairs_.end(),
              [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : a.second < b.second; });
    pairs_.erase(
        std::unique(pairs_.begin(), pairs_.end(), [](const auto& a, const auto& b) { return a.first == b.first && a.second == b.second; }),
        pairs_.end());
    return std::move(pairs_);
  }

 private:
  /// Many in one plane (cells of the ground, flat canopies): neighbours by a grid across the plane.
  void grid(std::span<const Flat> run) {
    const Vec3 n = glm::abs(run[0].normal);
    const int drop = n.z >= n.x && n.z >= n.y ? 2 : n.y >= n.x ? 1 : 0, ax = drop == 0 ? 1 : 0, ay = drop == 2 ? 1 : 2;
    Box all;
    for (const auto& f : run)
      for (const auto& p : candidates_[f.row].corners) all.add(p);
    const int side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(run.size()))));
    const auto cell = [&](double x, int axis) {
      const double extent = all.high[axis] - all.low[axis];
      return extent > 0 ? std::clamp(static_cast<int>((x - all.low[axis]) / extent * side), 0, side - 1) : 0;
    };
    std::vector<std::vector<std::uint32_t>> cells(static_cast<std::size_t>(side) * side);
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      Box box;
      for (const auto& p : candidates_[run[i].row].corners) box.add(p);
      for (int y = cell(box.low[ay], ay); y <= cell(box.high[ay], ay); ++y)
        for (int x = cell(box.low[ax], ax); x <= cell(box.high[ax], ax); ++x) cells[static_cast<std::size_t>(y) * side + x].push_back(i);
    }
    for (const auto& members : cells)
      for (std::size_t i = 0; i < members.size(); ++i)
        for (std::size_t j = i + 1; j < members.size(); ++j) test(run[members[i]], run[members[j]]);
  }

  void test(const Flat& f, const Flat& g) {
    const auto &a = candidates_[std::min(f.row, g.row)], &b = candidates_[std::max(f.row, g.row)];
    if (a.ground && b.ground) return;
    if (glm::length(f.normal) == 0.0 || glm::length(g.normal) == 0.0) return;
    if (std::abs(f.offset - g.offset) > 10 * plane_tolerance || glm::length(glm::cross(f.normal, g.normal)) > normal_tolerance) return;
    const Vec3 n = f.row < g.row ? f.normal : g.normal;
    double low = 1e300, high = -1e300;
    for (const auto& p : b.corners) {
      const double height = glm::dot(n, p - a.corners[0]);
      low = std::min(low, height), high = std::max(high, height);
    }
    if (std::max(std::abs(low), std::abs(high)) > plane_tolerance || !overlap(a.corners, b.corners, n)) return;
    const double height = 0.5 * (low + high);
    if (pairs_.size() == most_pairs)
      throw InputError("facets", fmt::format("more than {} pairs that lie on each other in one plane", most_pairs),
                       "surfaces that coincide in few places (is a plant placed many times on one spot, or is its `unit` wrong?)");
    pairs_.push_back({std::min(f.row, g.row), std::max(f.row, g.row), std::abs(height) < 1e-12 ? 0.0 : height});
  }

  std::span<const StackCandidate> candidates_;
  std::vector<Flat> flats_;
  std::vector<StackedPair> pairs_;
};

}  // namespace

Vec3 upward_normal(const Triangle& t) {
  const Vec3 a = area_vector(t);
  const double length = glm::length(a);
  if (!(length > 0.0)) return Vec3{0.0};
  Vec3 n = a / length;
  for (auto* c : {&n.x, &n.y, &n.z})
    if (std::abs(*c) < 1e-9) *c = 0.0;  // nearly upright planes: let rounding not turn the sign
  const bool up = n.z != 0.0 ? n.z > 0.0 : n.y != 0.0 ? n.y > 0.0 : n.x > 0.0;
  return up ? n : -n;
}

std::vector<StackedPair> find_stacked(std::span<const StackCandidate> candidates) {
  return Finder(candidates).run();
}

bool barycentric(const Triangle& t, const Vec3& p, double& u, double& v) {
  const Vec3 e = t[1] - t[0], f = t[2] - t[0], n = glm::cross(e, f), q = p - t[0];
  const double square = glm::dot(n, n);
  if (!(square > 0.0)) return false;
  u = glm::dot(glm::cross(q, f), n) / square;
  v = glm::dot(glm::cross(e, q), n) / square;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0;
}

}  // namespace sunfleck
