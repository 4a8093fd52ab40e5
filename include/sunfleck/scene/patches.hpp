// Connected pieces of surface, found from geometry: what light is resolved by, however a file names its parts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Facets of one copy and one material belong to one patch where they share an edge that folds by less than about 100 degrees: a leaf, a
/// stem's mantle. Corners are the same where their coordinates are, to a millionth of the plant's size; so a mesh without shared corners,
/// or with an organ for each triangle, has the patches of the one that it was made from. A facet of the ground is a patch, or many that
/// have one organ.
struct Patches {
  std::vector<std::uint32_t> of_facet;     ///< [n]
  std::vector<std::uint32_t> structure;    ///< [patches] row of its plant's structures, of its first facet; no_parent on the ground
  std::vector<std::uint32_t> end_of_copy;  ///< [copies] patches of a copy follow each other; then those of the ground
  std::size_t size() const { return structure.size(); }
};

/// Found once for each plant, from its first copy. Time and memory in proportion to the facets.
Patches find_patches(const FacetScene& facets);
/// The same of one plant's facets and their rows of optics, [n] each: patches are numbered by their first facets.
std::vector<std::uint32_t> patches_of_plant(std::span<const Triangle> corners, std::span<const std::uint32_t> optics);

/// Areas of patches [m^2] of which a mean is wanted: the middle one where each counts by its width (root of its area); the number of them,
/// where those smaller than a fifth of that count by what they are of it, since the grains of an ear do not make leaves small; and the
/// middle one where each counts so. Areas of zero are left out; all is zero if none is left.
struct PatchAreas {
  double sum = 0, count = 0, middle = 0;
};
PatchAreas patch_areas(std::vector<double> areas);

}  // namespace sunfleck
