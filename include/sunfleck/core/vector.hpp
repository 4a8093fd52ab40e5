// Vectors, boxes and affine maps in double precision. Lengths are metres unless a name says otherwise.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace sunfleck {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;
/// Coordinates of scenes lie within this distance of the origin along each axis [m]: two and a half times round the Earth, where doubles
/// are exact to 1e-8 m and everything that single precision holds is finite.
inline constexpr double farthest_coordinate = 1e8;
using Triangle = std::array<Vec3, 3>;  ///< corners [m]; the front is the side from which they run counter-clockwise

/// p -> linear * p + translation.
struct Affine {
  Mat3 linear{1.0};
  Vec3 translation{0.0};

  Vec3 point(const Vec3& p) const { return linear * p + translation; }
  Vec3 vector(const Vec3& v) const { return linear * v; }
  /// True if the map turns fronts into backs unless the corner order is swapped (negative determinant).
  bool mirrors() const { return glm::determinant(linear) < 0.0; }

  static Affine translate(const Vec3& t) { return {Mat3{1.0}, t}; }
  static Affine scale(double s) { return {Mat3{s}, Vec3{0.0}}; }
  /// Counter-clockwise turn about the vertical, seen from above [rad].
  static Affine turn(double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {Mat3{Vec3{c, s, 0}, Vec3{-s, c, 0}, Vec3{0, 0, 1}}, Vec3{0.0}};
  }
};

/// First b, then a.
inline Affine operator*(const Affine& a, const Affine& b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

/// Axis-aligned box; empty until something is added.
struct Box {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  void add(const Vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Vec3 size() const { return empty() ? Vec3{0.0} : high - low; }
};

/// Half the cross product of two edges: length is the area [m^2], direction is the front normal.
inline Vec3 area_vector(const Triangle& t) {
  return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
}

}  // namespace sunfleck
