// The mesh of a result, walked in batches of facets: what every mesh format is written from.
#pragma once

#include <functional>
#include <span>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "view/organ_patches.hpp"

namespace sunfleck {

/// Holds the distinct plants and the places of their copies; nothing that grows with the number of facets of the scene.
class LitMesh {
 public:
  /// Throws InputError where the file keeps no facets or no geometry.
  explicit LitMesh(const Result& result);

  const ResultGeometry& geometry() const { return geometry_; }
  const OrganPatches& patches() const { return patches_; }
  std::size_t facet_count() const { return geometry_.facet_count(); }

  /// Calls work(patches, first facet, number of facets) for all facets in order; progress runs from `begin` to `end` of the export.
  using Work = std::function<void(std::span<const PlacedPatch>, std::size_t, std::size_t)>;
  void for_each_batch(Progress& progress, double begin, double end, const Work& work) const;

 private:
  ResultGeometry geometry_;
  OrganPatches patches_;
};

/// "tile[3]/coffee[1]", or "ground" for copy = number of copies; `names` is /names/placement.
std::string placement_name(const Result& result, const ResultGeometry& geometry, const std::vector<std::string>& names, std::size_t copy);

}  // namespace sunfleck
