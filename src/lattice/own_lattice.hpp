// A finer lattice of a plant's own, which its copies share.
#pragma once

#include <vector>

#include <sunfleck/scene/placed_scene.hpp>

#include "lattice/facet_light.hpp"

namespace sunfleck {

/// Light of the stand's lattice anywhere in it.
class StandLight {
 public:
  StandLight(const LatticeMedium& medium, const LatticeLight& light) : medium_(medium), light_(light) {}
  /// Fluence [W m^-2] and flux [W m^-2] between the nodes, linear; the border's values half a cell beyond it, and nothing farther out.
  struct Here {
    double fluence = 0;
    Vec3 flux{0.0};
  };
  Here at(const Vec3& point) const;

 private:
  const LatticeMedium& medium_;
  const LatticeLight& light_;
};

/// Leaf area of a plant over nodes of its own frame. `sides` [facets]: as they are in one of its copies.
class OwnLattice {
 public:
  OwnLattice(const PlantFacets& facets, std::vector<OpenSides> sides, const std::vector<Optics>& materials, std::uint32_t nodes,
             LatticeMapping mapping, double density, std::size_t bands);

  const LatticeMedium& medium() const { return medium_; }
  /// Scattered light on the facets of a copy in one column: [facets][2] [W m^-2]. `sends`: power of each facet [W]; light of the stand
  /// comes in about it: f = w (fluence + 3 flux . c) spacing^2, as diffuse light has it.
  std::vector<float> light(const Affine& map, std::size_t band, const std::vector<double>& sends, const StandLight& stand,
                           const SteadySettings& settings, const Progress& progress) const;
  std::size_t bytes() const { return cells_.bytes() + medium_.bytes() + normal_.capacity() * sizeof(Vec3); }

 private:
  FacetCells cells_;
  LatticeMedium medium_;
  std::vector<Vec3> normal_;
  std::vector<OpenSides> sides_;
};

}  // namespace sunfleck
