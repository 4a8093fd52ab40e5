// 66 directions: the vertices of an octahedron whose faces were split twice.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

struct Octahedron {
  static constexpr std::size_t count = 66;
  std::vector<Vec3> directions;
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< 128
  std::vector<double> weights;                      ///< integrals of the interpolating functions over the sphere [sr]; their sum is 4 pi
};
const Octahedron& octahedron();

/// Up to three directions and their shares (sum 1) for a unit vector: linear on the split faces of the flat octahedron |x| + |y| + |z| = 1.
struct Interpolation {
  std::array<std::uint32_t, 3> row;
  std::array<double, 3> share;
};
Interpolation interpolate(const Vec3& direction);

}  // namespace sunfleck
