// Clusters of elements, the nodes between which far links run.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/radiosity/cluster_order.hpp>
#include <sunfleck/radiosity/elements.hpp>

namespace sunfleck {

/// Nodes of the scene's structure tree, cut off where a node holds at most `organs_per_cluster` organs: those are the leaf clusters.
/// Parents come before their children.
struct ClusterTree {
  std::vector<std::uint32_t> parent;               ///< [nodes] none for the root
  std::vector<std::uint32_t> depth;                ///< [nodes]
  std::vector<float> diameter;                     ///< [nodes] of the bounding box of its facets [m]
  std::vector<float> albedo;                       ///< [nodes] largest reflectance + transmittance of its facets in any band [-]
  std::vector<std::uint32_t> cluster_of_element;   ///< [elements] leaf cluster
  std::vector<std::uint32_t> first_element;        ///< [nodes + 1] into `elements`; empty runs for inner nodes
  std::vector<std::uint32_t> elements;             ///< elements of each leaf cluster
  std::vector<std::vector<std::uint32_t>> levels;  ///< nodes by depth
  static constexpr std::uint32_t none = 0xffffffffu;

  std::size_t size() const { return parent.size(); }
  std::size_t bytes() const;
};

ClusterTree make_cluster_tree(const FacetScene& facets, const Elements& elements);

}  // namespace sunfleck
