// The order in which patches stand so that structures, and neighbours within large structures, are consecutive.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/patches.hpp>

namespace sunfleck {

/// Nodes of at most this many patches are the leaf clusters between which far links run: small enough to be far from others early, large
/// enough that their channels cost less than the links they replace.
inline constexpr std::uint32_t patches_per_cluster = 32;
/// Within nodes of at most this many patches, small patches of one material share elements.
inline constexpr std::uint32_t patches_sharing_elements = 12;

/// A node of the cluster tree: a run of patches in tree order. Children come after their parent; leaves hold one patch.
struct ClusterNode {
  std::uint32_t first_patch = 0, patch_count = 0;  ///< positions in ClusterOrder::patches
  std::uint32_t first_child = 0, child_count = 0;  ///< consecutive nodes; 0 children = a leaf
  std::uint32_t parent = 0xffffffffu;
};

struct ClusterOrder {
  std::vector<std::uint32_t> patches;  ///< rows of Patches, plants first, ground last
  std::vector<ClusterNode> nodes;      ///< [0] the whole scene
};

/// Follows the scene's structures (groups, plants, axes, ...) and splits nodes of more than four children by the median of their
/// centroids along the longest axis (Smits, Arvo, Greenberg 1994, doi:10.1145/192161.192277).
ClusterOrder cluster_order(const Scene& scene, const FacetScene& facets, const Patches& patches);

}  // namespace sunfleck
