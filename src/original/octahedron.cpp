#include "original/octahedron.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace sunfleck {

namespace {

constexpr int parts = 4;  // of an edge: split twice

using Node = std::array<int, 3>;  // |x| + |y| + |z| = parts

struct Nodes {
  std::map<Node, std::uint32_t> rows;
  std::uint32_t row(const Node& n) const { return rows.at(n); }
};

const Nodes& nodes() {
  static const Nodes all = [] {
    Nodes n;
    for (int z = parts; z >= -parts; --z)
      for (int y = -parts; y <= parts; ++y)
        for (int x = -parts; x <= parts; ++x)
          if (std::abs(x) + std::abs(y) + std::abs(z) == parts) n.rows.emplace(Node{x, y, z}, static_cast<std::uint32_t>(n.rows.size()));
    return n;
  }();
  return all;
}

}  // namespace

Interpolation interpolate(const Vec3& d) {
  const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  const std::array<int, 3> sign{d.x < 0 ? -1 : 1, d.y < 0 ? -1 : 1, d.z < 0 ? -1 : 1};
  // In the positive octant, in units of the split: a + b + c = parts.
  const double a = std::abs(d.x) / sum * parts, b = std::abs(d.y) / sum * parts;
  const int i = std::clamp(static_cast<int>(a), 0, parts - 1), j = std::clamp(static_cast<int>(b), 0, parts - 1 - i);
  const double u = a - i, v = b - j;
  const auto at = [&](int x, int y) { return nodes().row({sign[0] * x, sign[1] * y, sign[2] * (parts - x - y)}); };
  if (u + v <= 1.0 || i + j >= parts - 1) return {{at(i, j), at(i + 1, j), at(i, j + 1)}, {1.0 - u - v, u, v}};
  return {{at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)}, {u + v - 1.0, 1.0 - u, 1.0 - v}};
}

const Octahedron& octahedron() {
  static const Octahedron all = [] {
    Octahedron o;
    o.directions.resize(Octahedron::count);
    for (const auto& [n, row] : nodes().rows) o.directions[row] = glm::normalize(Vec3{n[0], n[1], n[2]});
    // Integral over the sphere as one over the flat octahedron: solid angle of a piece dA of it is h dA / r^3, h = 1 / sqrt(3) its
    // distance.
    constexpr int fine = 96;
    o.weights.assign(Octahedron::count, 0.0);
    for (int octant = 0; octant < 8; ++octant) {
      const Vec3 sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
      for (int i = 0; i < fine; ++i)
        for (int j = 0; i + j < fine; ++j)
          for (int upper = 0; upper < 2; ++upper) {
            if (upper && i + j >= fine - 1) continue;
            const double third = upper ? 2.0 / 3.0 : 1.0 / 3.0;
            const double a = (i + third) / fine, b = (j + third) / fine;
            const Vec3 p = sign * Vec3{a, b, 1.0 - a - b};
            const double r = glm::length(p), angle = 1.0 / (r * r * r);
            const auto at = interpolate(p / r);
            for (std::size_t k = 0; k < 3; ++k) o.weights[at.row[k]] += at.share[k] * angle;
          }
    }
    double sum = 0;
    for (const double w : o.weights) sum += w;
    for (double& w : o.weights) w *= 4.0 * std::numbers::pi / sum;
    for (int octant = 0; octant < 8; ++octant) {
      const Vec3 sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
      for (int i = 0; i < parts; ++i)
        for (int j = 0; i + j < parts; ++j)
          for (int upper = 0; upper < (i + j < parts - 1 ? 2 : 1); ++upper) {
            const double third = upper ? 2.0 / 3.0 : 1.0 / 3.0, a = (i + third) / parts, b = (j + third) / parts;
            o.faces.push_back(interpolate(glm::normalize(sign * Vec3{a, b, 1.0 - a - b})).row);
          }
    }
    return o;
  }();
  return all;
}

}  // namespace sunfleck
