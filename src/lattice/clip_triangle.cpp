#include "lattice/clip_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

/// A convex piece of a triangle; each of at most six cuts adds a corner.
struct Piece {
  std::array<Vec3, 10> corner;
  int count = 0;
  void add(const Vec3& p) {
    if (count < static_cast<int>(corner.size())) corner[count++] = p;
  }
  double area() const {
    Vec3 sum{0.0};
    for (int i = 1; i + 1 < count; ++i) sum += glm::cross(corner[i] - corner[0], corner[i + 1] - corner[0]);
    return 0.5 * glm::length(sum);
  }
};

/// The parts of a piece below and above a plane across an axis.
void cut(const Piece& piece, int axis, double at, Piece& below, Piece& above) {
  below.count = above.count = 0;
  for (int i = 0; i < piece.count; ++i) {
    const Vec3 &a = piece.corner[i], &b = piece.corner[(i + 1) % piece.count];
    const double da = a[axis] - at, db = b[axis] - at;
    if (da <= 0.0) below.add(a);
    if (da >= 0.0) above.add(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
      const Vec3 crossing = a + da / (da - db) * (b - a);
      below.add(crossing), above.add(crossing);
    }
  }
}

std::int64_t floor_mod(std::int64_t a, std::int64_t n) {
  const std::int64_t r = a % n;
  return r < 0 ? r + n : r;
}

class Clipping {
 public:
  Clipping(const NodeGrid& grid, const Triangle& triangle, bool periodic, bool in_lowest_plane, std::vector<CellShare>& out)
      : grid_(grid), periodic_(periodic), axes_(in_lowest_plane ? 2 : 3), out_(out) {
    for (const auto& p : triangle) whole_.add((p - grid.low) / grid.cell);
    area_ = whole_.area();
  }

  void run() {
    if (area_ > 0.0) slices(whole_, 0, {0, 0, 0});
  }

 private:
  void slices(const Piece& piece, int axis, std::array<std::int64_t, 3> cell) {
    if (axis == axes_) return keep(piece, cell);
    double low = piece.corner[0][axis], high = low;
    for (int i = 1; i < piece.count; ++i) low = std::min(low, piece.corner[i][axis]), high = std::max(high, piece.corner[i][axis]);
    auto first = static_cast<std::int64_t>(std::floor(low)), last = std::max(first, static_cast<std::int64_t>(std::ceil(high)) - 1);
    const bool wraps = periodic_ && axis < 2;
    if (!wraps) {
      if (last < 0 || first >= grid_.n[axis]) {  // a point on the border belongs inside
        if (!(high >= 0.0 && low <= static_cast<double>(grid_.n[axis]))) return;
        first = last = std::clamp<std::int64_t>(first, 0, grid_.n[axis] - 1);
      }
    }
    Piece rest = piece, below, above;
    for (std::int64_t i = first; i <= last && rest.count > 2; ++i) {
      const bool inside = wraps || (i >= 0 && i < grid_.n[axis]);
      cell[axis] = wraps ? floor_mod(i, grid_.n[axis]) : i;
      if (i == last) {
        if (inside) slices(rest, axis + 1, cell);
        return;
      }
      cut(rest, axis, static_cast<double>(i + 1), below, above);
      if (inside && below.count > 2) slices(below, axis + 1, cell);
      rest = above;
    }
  }

  void keep(const Piece& piece, const std::array<std::int64_t, 3>& cell) {
    const double share = piece.area() / area_;
    if (!(share > 0.0)) return;
    const auto node = static_cast<std::uint32_t>((cell[2] * grid_.n[1] + cell[1]) * grid_.n[0] + cell[0]);
    out_.push_back({node, static_cast<float>(share)});
  }

  const NodeGrid& grid_;
  const bool periodic_;
  const int axes_;
  std::vector<CellShare>& out_;
  Piece whole_;
  double area_ = 0;
};

}  // namespace

void clip_to_cells(const NodeGrid& grid, const Triangle& triangle, bool periodic, bool in_lowest_plane, std::vector<CellShare>& out) {
  Clipping(grid, triangle, periodic, in_lowest_plane, out).run();
}

}  // namespace sunfleck
