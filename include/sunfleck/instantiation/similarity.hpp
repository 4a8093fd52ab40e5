// Rotation or mirror, uniform scale and move: the maps under which light in a structure is the same.
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

/// None if the map stretches or shears by more than 1e-6: then copies share geometry, not light.
std::optional<Similarity> similarity_of(const Affine& map);

}  // namespace sunfleck
