// The order in which organs stand so that structures, and neighbours within large structures, are consecutive.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/scene/facets.hpp>

namespace sunfleck {

/// Clusters between which far links run have at least this many organs, but where the tree has no smaller node.
inline constexpr std::uint32_t organs_per_cluster = 12;

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
