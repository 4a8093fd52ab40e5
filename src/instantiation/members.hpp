// A scene as members of originals, ready for light.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/instantiation/operator_store.hpp>
#include <sunfleck/visibility/copies.hpp>

#include "instantiation/line_operator.hpp"
#include "instantiation/originals.hpp"

namespace sunfleck {

/// An original as light sees it. The original's frame: p = elements.surface.origin + (coordinates of the surface).
struct OriginalLight {
  Elements elements;
  std::vector<std::uint8_t> interior;         ///< interior_of_cells()
  std::vector<std::uint32_t> facet_material;  ///< [n] row of Scene::optics, by facet of the original
  std::vector<std::uint32_t> facet_of_part;   ///< [parts + 1] first facet of each part
  std::unique_ptr<LineOperator> coarse;
  std::string key;  ///< of its content, in a solve with a store

  std::size_t bytes() const;
  /// Drops all but what rays that end in its copies ask for.
  void forget();
  /// The part that a facet of the original belongs to.
  std::size_t part_of(std::uint32_t facet) const {
    return static_cast<std::size_t>(std::upper_bound(facet_of_part.begin(), facet_of_part.end(), facet) - facet_of_part.begin() - 1);
  }
};

/// Members and what they share. `copies` points into `originals`.
struct Members {
  Approximation approximation;
  Originals found;
  std::vector<OriginalLight> originals;
  std::vector<Similarity> maps;         ///< per member, those far away included
  std::vector<std::uint32_t> stand_in;  ///< per member far away: whose light it has
  CopyScene copies;                     ///< per member, with the ground
  std::vector<std::uint32_t>
      ground_parts;           ///< [facets + 1] first of the parts of `copies.ground` as which each facet, but far ones, stands
  std::uint64_t merged = 0;   ///< copies that were put together with others
  double tangled = 0;         ///< see much_tangled
  std::size_t made_with = 0;  ///< the most that originals held while they were made [bytes]

  /// In which light is solved.
  std::size_t size() const { return found.solved; }
  std::size_t bytes() const;
  bool is_far(std::size_t member) const { return member >= found.solved; }
  std::uint64_t original_facets(std::size_t member) const { return found.originals[found.members[member].original].facets; }
  const OriginalLight& original_of(std::size_t member) const { return originals[found.members[member].original]; }
  const LineOperator& coarse_of(std::size_t member) const { return *original_of(member).coarse; }
};

/// Finds originals, traces their coarse operators, and puts copies that reach into each other together: what stands between two leaves
/// of a copy and is not of it is missing in the original's operator (measured in docs/instantiation.md). A copy into which others reach in
/// more than a twentieth of the lines is put together with all of them. Where that would cost more facets than the scene's originals have
/// and 300,000 besides, the least tangled are left as they are.
/// Members that stand in for structures stay apart: what they hide of each other is part of the approximation until they are opened.
Members make_members(const Scene& scene, const PlacedScene& placed, const Classification* classes, const OperatorDensity& coarse,
                     double elements_per_organ, std::uint64_t seed, Progress& progress, OperatorStore* store = nullptr);

/// Of an original's coarse operator. Pieces of plants are small and many: coarser fields do.
OperatorDensity coarse_density(const Scene& scene, const Original& original, OperatorDensity coarse);

/// An original without its operator, cut into elements and sampled as if it had at least `fewest_organs` (see fewest_organs()).
OriginalLight original_light(const Scene& scene, const Approximation& approximation, const Original& original, double elements_per_organ,
                             const OperatorDensity& density, double fewest_organs, std::uint64_t seed, Progress& progress);

}  // namespace sunfleck
