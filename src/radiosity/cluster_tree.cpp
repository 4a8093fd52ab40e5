#include "cluster_tree.hpp"

#include <algorithm>

#include <sunfleck/core/memory.hpp>

namespace sunfleck {

std::size_t ClusterTree::bytes() const {
  std::size_t total = bytes_of(parent) + bytes_of(depth) + bytes_of(diameter) + bytes_of(albedo) + bytes_of(cluster_of_element) +
                      bytes_of(first_element) + bytes_of(elements);
  for (const auto& l : levels) total += bytes_of(l);
  return total;
}

ClusterTree make_cluster_tree(const FacetScene& facets, const Elements& e) {
  ClusterTree tree;
  const auto& nodes = e.tree.nodes;
  std::vector<std::uint32_t> kept(nodes.size(), ClusterTree::none), cluster_of_patch(e.tree.patches.size(), 0);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const auto up = nodes[i].parent;
    const bool below_leaf = up != ClusterTree::none && (kept[up] == ClusterTree::none || nodes[up].patch_count <= patches_per_cluster);
    if (below_leaf) continue;
    kept[i] = static_cast<std::uint32_t>(tree.parent.size());
    tree.parent.push_back(up == ClusterTree::none ? ClusterTree::none : kept[up]);
    tree.depth.push_back(up == ClusterTree::none ? 0 : tree.depth[kept[up]] + 1);
    if (nodes[i].patch_count <= patches_per_cluster || nodes[i].child_count == 0)
      for (std::uint32_t k = 0; k < nodes[i].patch_count; ++k) cluster_of_patch[e.tree.patches[nodes[i].first_patch + k]] = kept[i];
  }
  std::vector<Box> box(tree.size());
  tree.albedo.assign(tree.size(), 0.0f);
  for (std::size_t t = 0; t < e.order.size(); ++t) {
    const auto f = e.order[t];
    if (facets.area[f] == 0.0f) continue;
    const auto c = cluster_of_patch[e.patch_of_row[t]];
    for (const auto& p : facets.corners[f]) box[c].add(p);
    const auto& m = facets.materials[facets.optics[f]];
    for (std::size_t b = 0; b < facets.bands; ++b)
      tree.albedo[c] = std::max(tree.albedo[c], std::max(m.reflectance_front[b], m.reflectance_back[b]) + m.transmittance[b]);
  }
  tree.diameter.resize(tree.size());
  for (std::size_t i = tree.size(); i-- > 0;) {
    tree.diameter[i] = static_cast<float>(glm::length(box[i].size()));
    if (const auto up = tree.parent[i]; up != ClusterTree::none) {
      if (!box[i].empty()) box[up].add(box[i]);
      tree.albedo[up] = std::max(tree.albedo[up], tree.albedo[i]);
    }
  }
  tree.cluster_of_element.resize(e.size());
  tree.first_element.assign(tree.size() + 1, 0);
  for (std::size_t i = 0; i < e.size(); ++i) {
    const auto c = cluster_of_patch[e.patch_of_row[e.row_of_cell[e.cells[e.first_cell[i]]]]];
    tree.cluster_of_element[i] = c;
    ++tree.first_element[c + 1];
  }
  for (std::size_t c = 0; c < tree.size(); ++c) tree.first_element[c + 1] += tree.first_element[c];
  tree.elements.resize(e.size());
  auto cursor = tree.first_element;
  for (std::uint32_t i = 0; i < e.size(); ++i) tree.elements[cursor[tree.cluster_of_element[i]]++] = i;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    if (tree.levels.size() <= tree.depth[i]) tree.levels.resize(tree.depth[i] + 1);
    tree.levels[tree.depth[i]].push_back(i);
  }
  return tree;
}

}  // namespace sunfleck
