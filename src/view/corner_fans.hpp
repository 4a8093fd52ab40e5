// From one value a facet to values at its corners, per distinct mesh.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <sunfleck/view/drawn_scene.hpp>

namespace sunfleck {

/// For each corner of a shape's triangles those triangles of the shape that share it (same coordinates to the bit) and meet the corner's
/// own at less than 60 degrees; made once for each distinct piece of mesh. A corner's value is the area-weighted mean over its fan.
class CornerFans {
 public:
  explicit CornerFans(const DrawnScene& scene);

  struct Piece {
    std::vector<std::uint32_t> begin;     ///< [3 triangles + 1]
    std::vector<std::uint32_t> triangle;  ///< of the shape
    std::vector<float> area;              ///< [triangles], in the mesh's own unit: only their ratios matter
  };
  /// Null where facets keep their own value: the piece has more than 2^20 triangles.
  const Piece* piece(const DrawnScene::Place& place) const;

 private:
  const DrawnScene& scene_;
  std::vector<std::unique_ptr<const Piece>> pieces_;
  std::vector<std::vector<std::uint32_t>> row_;  ///< [plants][shapes]
  std::unique_ptr<const Piece> ground_;
};

}  // namespace sunfleck
