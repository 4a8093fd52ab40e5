// The order in which organs stand so that structures, and neighbours within large structures, are consecutive.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Nodes of at most this many organs are the leaf clusters between which far links run: small enough to be far from others early, large
/// enough that their channels cost less than the links they replace.
inline constexpr std::uint32_t organs_per_cluster = 32;
/// Within nodes of at most this many organs, small organs of one material share elements.
inline constexpr std::uint32_t organs_sharing_elements = 12;

/// A node of the cluster tree: a run of organs in tree order. Children come after their parent; leaves hold one organ.
struct ClusterNode {
  std::uint32_t first_organ = 0, organ_count = 0;  ///< positions in ClusterOrder::organs
  std::uint32_t first_child = 0, child_count = 0;  ///< consecutive nodes; 0 children = a leaf
  std::uint32_t parent = 0xffffffffu;
};

struct ClusterOrder {
  std::vector<std::uint32_t> organs;  ///< rows of FacetScene::organs, plants first, ground last
  std::vector<ClusterNode> nodes;     ///< [0] the whole scene
};

/// Follows the scene's structures (groups, plants, axes, ...) and splits nodes of more than four children by the median of their
/// centroids along the longest axis (Smits, Arvo, Greenberg 1994, doi:10.1145/192161.192277).
ClusterOrder cluster_order(const Scene& scene, const FacetScene& facets);

}  // namespace sunfleck
