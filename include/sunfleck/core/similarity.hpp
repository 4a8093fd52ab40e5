// Rotation or mirror, uniform scale and move: the maps under which shapes are alike, and the light in them is the same.
#pragma once

#include <optional>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// p -> scale * turn * p + move, `turn` orthogonal (a mirror where its determinant is -1), scale > 0.
struct Similarity {
  double scale = 1;
  Mat3 turn{1.0};
  Vec3 move{0.0};

  Vec3 point(const Vec3& p) const { return scale * (turn * p) + move; }
  Vec3 direction(const Vec3& d) const { return turn * d; }
  Vec3 point_back(const Vec3& p) const { return glm::transpose(turn) * (p - move) / scale; }
  Vec3 direction_back(const Vec3& d) const { return glm::transpose(turn) * d; }
  Affine affine() const { return {turn * scale, move}; }
};

/// The map as a similarity, of scale |det linear|^(1/3). None if linear^T linear / scale^2 is off the identity by more than `tolerance` in
/// any entry (the map stretches or shears: copies then share geometry, not light), or if the scale is zero or not finite.
std::optional<Similarity> similarity_of(const Affine& map, double tolerance = 1e-6);

}  // namespace sunfleck
