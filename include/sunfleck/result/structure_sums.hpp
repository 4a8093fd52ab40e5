// What structures within plants absorb, where `stop_at` ends opening inside plants.
#pragma once

#include <map>
#include <vector>

#include <sunfleck/scene/absorptance.hpp>
#include <sunfleck/scene/depth.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Does `stop_at` name structures within plants that are opened?
bool stops_inside(const PlacedScene& placed);

/// The layout of a result that keeps structures instead of facets and organs: no copies; PlacedScene::closed goes on, copy by copy, with a
/// row for each structure that `stop_at` names, after a row for the rest of its plant where that has facets. Throws InputError if no plant
/// has such a structure.
PlacedScene structures_layout(const Scene& scene, const PlacedScene& placed);

/// Adds up facets' light by structure; rows of the ground go on to another sink. Memory: 8 bytes a structure, state and band.
class StructureSums final : public IrradianceSink {
 public:
  /// All must outlive it. `layout`: structures_layout().
  StructureSums(const Scene& scene, const PlacedScene& placed, const PlacedScene& layout, IrradianceSink& ground);

  void rows(const IrradianceRows& rows) override;
  /// Appends [k][s][b] absorbed [W] of the rows that structures_layout() has added.
  void append(std::vector<double>& structures) const { structures.insert(structures.end(), sums_.begin(), sums_.end()); }

 private:
  const Scene& scene_;
  const PlacedScene& placed_;
  const PlacedScene& layout_;
  IrradianceSink& ground_;
  FacetRows rows_;
  Absorptance absorptance_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> row_of_organ_;  ///< by plant; rows count from the copy's first
  std::vector<std::size_t> first_row_;                                ///< [copies]
  std::vector<double> sums_;
};

}  // namespace sunfleck
