// Facets that lie exactly on each other, for which single precision has no order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// A facet, or an image of one, in units of the scene's size.
struct StackCandidate {
  Triangle corners;
  std::uint32_t index = 0;  ///< of the caller
  bool ground = false;      ///< two of the ground are never compared
};

/// Two candidates that overlap in one plane; `height` is how far the second lies above the first along the upward normal of the
/// first (see upward_normal), exactly 0 if below 1e-12.
struct StackedPair {
  std::uint32_t first, second;
  double height;
};

/// Unit normal with positive z, or positive y where z is zero, or positive x. (0,0,0) for no area.
Vec3 upward_normal(const Triangle& t);

std::vector<StackedPair> find_stacked(std::span<const StackCandidate> candidates);

/// Barycentric coordinates (u, v) of the point of the plane of t nearest to p; true if inside.
bool barycentric(const Triangle& t, const Vec3& p, double& u, double& v);

}  // namespace sunfleck
