// Light carried along the directions of a lattice from node to node until it leaves.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "lattice/medium.hpp"

namespace sunfleck {

/// Which directions: those that rise, those that sink, those that stay level. Each group can be carried by itself.
enum class LatticeGroup { rising, sinking, level };
inline constexpr std::array<LatticeGroup, 3> lattice_groups{LatticeGroup::rising, LatticeGroup::sinking, LatticeGroup::level};
inline bool in_group(std::size_t direction, LatticeGroup group) {
  const int z = lattice_step[direction][2];
  return group == LatticeGroup::rising ? z > 0 : group == LatticeGroup::sinking ? z < 0 : z == 0;
}

/// One direction of one band. `Light` says what happens at a node:
///     double sent(std::size_t node)            what goes out besides what passes
///     void arrives(std::size_t node, double f) light that comes in
///     double enters(x, y, z)                   light from outside into a node at the border whose upstream neighbour does not exist
/// Returns what leaves the lattice.
template <class Light>
class DirectionSweep {
 public:
  DirectionSweep(const LatticeMedium& medium, std::size_t band, std::size_t direction, Light light)
      : medium_(medium),
        light_(light),
        passes_(medium.passes.data() + band * medium.nodes()),
        nx_(medium.grid.n[0]),
        ny_(medium.grid.n[1]),
        planes_(static_cast<std::int64_t>(medium.planes())),
        ground_(medium.ground ? 1 : 0),
        cx_(lattice_step[direction][0]),
        cy_(lattice_step[direction][1]),
        cz_(lattice_step[direction][2]) {}

  double run() { return cz_ == 0 ? level() : across_planes(); }

 private:
  /// Plane by plane, in rows with a border of one node.
  double across_planes() {
    const std::int64_t width = nx_ + 2;
    std::vector<double> here(static_cast<std::size_t>(width * (ny_ + 2)), 0.0), next(here);
    double out = 0.0;
    const std::int64_t first = cz_ > 0 ? 0 : planes_ - 1, last = cz_ > 0 ? planes_ - 1 : 0;
    if (!(cz_ > 0 && ground_))
      for (std::int64_t y = 0; y < ny_; ++y)
        for (std::int64_t x = 0; x < nx_; ++x) here[(y + 1) * width + x + 1] = light_.enters(x, y, first - ground_);
    for (std::int64_t z = first;; z += cz_) {
      std::fill(next.begin(), next.end(), 0.0);
      for (std::int64_t y = 0; y < ny_; ++y) {
        const double* from = here.data() + (y + 1) * width + 1;
        double* to = next.data() + (y + 1 + cy_) * width + 1 + cx_;
        const std::size_t row = static_cast<std::size_t>((z * ny_ + y) * nx_);
        for (std::int64_t x = 0; x < nx_; ++x) {
          const std::size_t node = row + static_cast<std::size_t>(x);
          light_.arrives(node, from[x]);
          to[x] = passes_[node] * from[x] + light_.sent(node);
        }
      }
      if (cz_ < 0 && ground_ && z == 0) return out;  // what sinks ends in the ground, which sends nothing down
      if (z == last) {
        for (const double f : next) out += f;
        return out;
      }
      out += cross_border(next, width, z + cz_);
      std::swap(here, next);
    }
  }

  /// Light beyond the sides of a plane goes round, or out; and what comes in there.
  double cross_border(std::vector<double>& plane, std::int64_t width, std::int64_t z) {
    const auto at = [&](std::int64_t x, std::int64_t y) -> double& { return plane[static_cast<std::size_t>((y + 1) * width + x + 1)]; };
    double out = 0.0;
    const auto move = [&](std::int64_t x, std::int64_t y) {
      double& f = at(x, y);
      if (medium_.periodic)
        at((x + nx_) % nx_, (y + ny_) % ny_) += f;
      else
        out += f;
      f = 0.0;
    };
    if (cx_ != 0)
      for (std::int64_t y = -1; y <= ny_; ++y) move(cx_ > 0 ? nx_ : -1, y);
    if (cy_ != 0)
      for (std::int64_t x = -1; x <= nx_; ++x) move(x, cy_ > 0 ? ny_ : -1);
    if (medium_.periodic || z < ground_) return out;
    const std::int64_t side_x = cx_ > 0 ? 0 : nx_ - 1, side_y = cy_ > 0 ? 0 : ny_ - 1;
    if (cx_ != 0)
      for (std::int64_t y = 0; y < ny_; ++y) at(side_x, y) = light_.enters(side_x, y, z - ground_);
    if (cy_ != 0)
      for (std::int64_t x = 0; x < nx_; ++x) at(x, side_y) = light_.enters(x, side_y, z - ground_);
    return out;
  }

  /// Line by line in each plane of leaves; lines that go round a periodic cell come back to where they began.
  double level() {
    double out = 0.0;
    for (std::int64_t z = ground_; z < planes_; ++z) {
      if (!medium_.periodic) {
        if (cx_ != 0)
          for (std::int64_t y = 0; y < ny_; ++y) out += line(cx_ > 0 ? 0 : nx_ - 1, y, z);
        if (cy_ != 0)
          for (std::int64_t x = 0; x < nx_; ++x)
            if (cx_ == 0 || x != (cx_ > 0 ? 0 : nx_ - 1)) out += line(x, cy_ > 0 ? 0 : ny_ - 1, z);
        continue;
      }
      const std::int64_t rings = cx_ == 0 ? nx_ : cy_ == 0 ? ny_ : std::gcd(nx_, ny_), nodes = nx_ * ny_ / rings;
      for (std::int64_t r = 0; r < rings; ++r) ring(cx_ == 0 || cy_ != 0 ? r : 0, cx_ == 0 || cy_ != 0 ? 0 : r, z, nodes);
    }
    return out;
  }

  double line(std::int64_t x, std::int64_t y, std::int64_t z) {
    double f = light_.enters(x, y, z - ground_);
    for (; x >= 0 && x < nx_ && y >= 0 && y < ny_; x += cx_, y += cy_) {
      const auto node = static_cast<std::size_t>((z * ny_ + y) * nx_ + x);
      light_.arrives(node, f);
      f = passes_[node] * f + light_.sent(node);
    }
    return f;
  }

  /// f after a round is (what is sent on the way) + f (what passes the whole round): the steady f is the sum of all rounds.
  void ring(std::int64_t x0, std::int64_t y0, std::int64_t z, std::int64_t nodes) {
    const auto round = [&](double f, bool keep, double& passed) {
      std::int64_t x = x0, y = y0;
      for (std::int64_t i = 0; i < nodes; ++i) {
        const auto node = static_cast<std::size_t>((z * ny_ + y) * nx_ + x);
        if (keep) light_.arrives(node, f);
        f = passes_[node] * f + light_.sent(node);
        passed *= passes_[node];
        x += cx_, y += cy_;
        x += x < 0 ? nx_ : x >= nx_ ? -nx_ : 0, y += y < 0 ? ny_ : y >= ny_ ? -ny_ : 0;
      }
      return f;
    };
    double passed = 1.0, again = 1.0;
    const double once = round(0.0, false, passed);
    if (once != 0.0 && passed < 1.0) round(once / (1.0 - passed), true, again);
  }

  const LatticeMedium& medium_;
  Light light_;
  const double* passes_;
  const std::int64_t nx_, ny_, planes_, ground_, cx_, cy_, cz_;
};

}  // namespace sunfleck
