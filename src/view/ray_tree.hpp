// Trees of triangles that hold trees: the acceleration structure of PlacedRays.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include <sunfleck/view/placed_rays.hpp>

#include "visibility/embree_scene.hpp"

namespace sunfleck::raytree {

struct TreeNode;

/// A copy of a node within another.
struct Child {
  std::array<float, 12> to_local;  ///< rows [linear | translation], the parent's coordinates -> the child's
  const TreeNode* node;
  std::uint64_t first;  ///< facet of the parent that is the child's facet 0
};

/// Triangles and copies of other nodes, in single precision about the middle of the node.
struct TreeNode {
  Vec3 middle{0.0};                     ///< in the frame of the plant or mesh; the origin of the node's coordinates
  Box box;                              ///< node's coordinates
  std::vector<std::uint32_t> facet_of;  ///< [triangles]; empty: triangle = facet
  std::vector<Child> children;
  std::vector<RTCBounds> child_bounds;  ///< until the tree stands
  EmbreeScenePointer scene;

  std::uint64_t facet(unsigned triangle) const { return facet_of.empty() ? triangle : facet_of[triangle]; }
};

/// Rides along with a ray through the levels.
struct TreeQuery : RTCIntersectContext {
  const TreeNode* node;
  Vec3 origin, direction;  ///< in the node's coordinates
  std::uint64_t base;      ///< facet of the world that is the node's facet 0
  std::size_t start;       ///< facet left out
  std::size_t facet;       ///< met
};

class Tree {
 public:
  Tree(const DrawnScene& scene, std::size_t written_out);
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;

  const TreeNode* world() const { return world_; }
  const TreeNode* ground() const { return ground_; }  ///< null where there is none
  /// Of all that has area, in the world, a little widened.
  Box box() const { return {world_->box.low + world_->middle, world_->box.high + world_->middle}; }
  /// World coordinates. `any`: is satisfied with whatever the ray meets.
  PlacedHit trace(const TreeNode* node, const Vec3& origin, const Vec3& direction, double from, double to, std::size_t start,
                  bool any) const;
  std::size_t bytes() const;

 private:
  /// A piece of a mesh, to be placed often.
  struct Piece {
    std::uint32_t mesh, first, count;
    friend auto operator<=>(const Piece&, const Piece&) = default;
  };

  TreeNode* new_node();
  TreeNode* mesh_node(const Mesh& mesh, std::size_t first, std::size_t count);
  TreeNode* plant_node(const Plant& plant, bool write_out);
  /// Adds a copy of a node under a map from the child's frame to the parent's; nothing where the map is flat.
  static void place(TreeNode& parent, const TreeNode& child, const Affine& map, std::uint64_t first);
  void set_triangles(TreeNode& node, const std::vector<Triangle>& triangles);
  void finish(TreeNode& node);

  EmbreeDevice device_{EmbreeDevice::Trees::same_for_any_threads};
  std::vector<std::unique_ptr<TreeNode>> nodes_;
  const TreeNode* world_ = nullptr;
  const TreeNode* ground_ = nullptr;
  std::uint64_t ground_first_ = 0;
};

}  // namespace sunfleck::raytree
