#include <sunfleck/instantiation/similarity.hpp>

namespace sunfleck {

std::optional<Similarity> similarity_of(const Affine& map) {
  constexpr double tolerance = 1e-6;
  const double scale = std::cbrt(std::fabs(glm::determinant(map.linear)));
  if (!(scale > 0.0)) return std::nullopt;
  Similarity out{scale, map.linear / scale, map.translation};
  const Mat3 unit = glm::transpose(out.turn) * out.turn;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::fabs(unit[i][j] - (i == j ? 1.0 : 0.0)) > tolerance) return std::nullopt;
  return out;
}

}  // namespace sunfleck
