#include <sunfleck/core/similarity.hpp>

namespace sunfleck {

std::optional<Similarity> similarity_of(const Affine& map, double tolerance) {
  const double scale = std::cbrt(std::abs(glm::determinant(map.linear)));
  if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
  const Similarity out{scale, map.linear / scale, map.translation};
  const Mat3 unit = glm::transpose(out.turn) * out.turn;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(unit[c][r] - (c == r ? 1.0 : 0.0)) <= tolerance)) return std::nullopt;
  return out;
}

}  // namespace sunfleck
