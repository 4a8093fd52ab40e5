#include "occlusion/shell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunfleck {

namespace {

constexpr std::int64_t most_columns_a_side = 1024;
constexpr int farthest_columns = 4096;  // of a ray between columns: along the horizon in a periodic scene it would never end

std::int64_t floor_mod(std::int64_t a, std::int64_t n) {
  const std::int64_t r = a % n;
  return r < 0 ? r + n : r;
}

}  // namespace

ShellGrid::ShellGrid(std::vector<CrownShell> shells, const std::optional<PeriodicCell>& periodic)
    : shells_(std::move(shells)), periodic_(periodic.has_value()) {
  double width = 0.0;
  for (const auto& s : shells_) {
    extinction_.push_back(s.extinction());
    const Vec3 half = s.half_extent();
    box_.add(s.centre - half), box_.add(s.centre + half);
    width += half.x + half.y;
  }
  if (shells_.empty()) box_.add(Vec3{0.0});
  if (periodic) {
    box_.low.x = periodic->x_low, box_.low.y = periodic->y_low;
    box_.high.x = periodic->x_high, box_.high.y = periodic->y_high;
  }
  const double wanted = shells_.empty() ? 1.0 : width / static_cast<double>(shells_.size());  // a mean diameter
  for (int axis = 0; axis < 2; ++axis) {
    const double extent = std::max(box_.high[axis] - box_.low[axis], 1e-9);
    cells_[axis] =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(std::min(extent / std::max(wanted, 1e-9), 1e6)), 1, most_columns_a_side);
    cell_[axis] = extent / static_cast<double>(cells_[axis]);
  }
  fill();
}

void ShellGrid::fill() {
  const auto columns = static_cast<std::size_t>(cells_[0] * cells_[1]);
  std::vector<std::pair<std::uint32_t, Entry>> all;
  for (std::uint32_t s = 0; s < shells_.size(); ++s) {
    const Vec3 half = shells_[s].half_extent();
    std::array<std::int64_t, 2> low{}, high{};
    for (int axis = 0; axis < 2; ++axis) {
      const double at = shells_[s].centre[axis] - box_.low[axis];
      low[axis] = static_cast<std::int64_t>(std::floor((at - half[axis]) / cell_[axis]));
      high[axis] = static_cast<std::int64_t>(std::floor((at + half[axis]) / cell_[axis]));
      if (!periodic_)
        low[axis] = std::clamp<std::int64_t>(low[axis], 0, cells_[axis] - 1),
        high[axis] = std::clamp<std::int64_t>(high[axis], 0, cells_[axis] - 1);
    }
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t i = low[0]; i <= high[0]; ++i) {
        const std::int64_t ii = floor_mod(i, cells_[0]), jj = floor_mod(j, cells_[1]);
        // seen from column ii of the cell itself the shell stands as many cells back as its own column lies beyond
        all.push_back({static_cast<std::uint32_t>(jj * cells_[0] + ii),
                       {s, static_cast<std::int32_t>((ii - i) / cells_[0]), static_cast<std::int32_t>((jj - j) / cells_[1])}});
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  first_.assign(columns + 1, 0);
  for (const auto& [column, entry] : all) {
    ++first_[column + 1];
    entries_.push_back(entry);
  }
  for (std::size_t c = 0; c < columns; ++c) first_[c + 1] += first_[c];
}

double ShellGrid::in_column(std::size_t column, const Vec3& origin, const Vec3& direction, double from, double to,
                            std::array<std::int64_t, 2> wraps, std::uint32_t own) const {
  double depth = 0.0;
  for (auto e = first_[column]; e < first_[column + 1]; ++e) {
    const auto& entry = entries_[e];
    const std::int64_t x = wraps[0] + entry.image_x, y = wraps[1] + entry.image_y;
    if (entry.shell == own && x == 0 && y == 0) continue;
    const Vec3 moved =
        origin - Vec3{static_cast<double>(x) * (box_.high.x - box_.low.x), static_cast<double>(y) * (box_.high.y - box_.low.y), 0.0};
    depth += extinction_[entry.shell] * shells_[entry.shell].chord(moved, direction, from, to);
  }
  return depth;
}

double ShellGrid::optical_depth(const Vec3& origin, const Vec3& direction, std::uint32_t own) const {
  if (shells_.empty()) return 0.0;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double from = 0.0, end = infinity;
  const int clipped_axes[] = {2, 0, 1};
  for (int n = 0; n < (periodic_ ? 1 : 3); ++n) {  // to the box, and out of it
    const int axis = clipped_axes[n];
    const double d = direction[axis], low = box_.low[axis] - origin[axis], high = box_.high[axis] - origin[axis];
    if (d == 0.0) {
      if (low > 0.0 || high < 0.0) return 0.0;
      continue;
    }
    from = std::max(from, std::min(low / d, high / d));
    end = std::min(end, std::max(low / d, high / d));
  }
  if (!(from < end)) return 0.0;
  std::array<std::int64_t, 2> at{}, step{};
  std::array<double, 2> next{}, stride{};
  for (int axis = 0; axis < 2; ++axis) {
    const double place = (origin[axis] + from * direction[axis] - box_.low[axis]) / cell_[axis];
    at[axis] = static_cast<std::int64_t>(std::floor(place));
    if (!periodic_) at[axis] = std::clamp<std::int64_t>(at[axis], 0, cells_[axis] - 1);
    const double d = direction[axis];
    step[axis] = d > 0.0 ? 1 : -1;
    stride[axis] = d != 0.0 ? cell_[axis] / std::abs(d) : infinity;
    const double border = box_.low[axis] + static_cast<double>(at[axis] + (d > 0.0 ? 1 : 0)) * cell_[axis];
    next[axis] = d != 0.0 ? (border - origin[axis]) / d : infinity;
  }
  double depth = 0.0;
  for (int walked = 0; walked < farthest_columns && depth < opaque; ++walked) {
    const int axis = next[0] < next[1] ? 0 : 1;
    const double to = std::min(next[axis], end);
    const std::int64_t i = floor_mod(at[0], cells_[0]), j = floor_mod(at[1], cells_[1]);
    depth += in_column(static_cast<std::size_t>(j * cells_[0] + i), origin, direction, from, to,
                       {(at[0] - i) / cells_[0], (at[1] - j) / cells_[1]}, own);
    if (next[axis] >= end) break;
    from = std::max(from, to);
    at[axis] += step[axis];
    if (!periodic_ && (at[axis] < 0 || at[axis] >= cells_[axis])) break;
    next[axis] += stride[axis];
  }
  return depth;
}

std::size_t ShellGrid::bytes() const {
  return shells_.capacity() * sizeof(CrownShell) + extinction_.capacity() * sizeof(double) + first_.capacity() * sizeof(std::uint32_t) +
         entries_.capacity() * sizeof(Entry);
}

}  // namespace sunfleck
