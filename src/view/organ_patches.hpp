// Meshes of organs whose facets share vertices, and which facets meet at each vertex.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <sunfleck/result/result_geometry.hpp>

namespace sunfleck {

/// A run of consecutive facets that holds its organs whole. Corners of facets of one organ with the same coordinates (to the bit) are one
/// vertex; organs share none. Adjacency is OpenMesh's: a facet that would make an edge or a vertex of it non-manifold (a third facet at an
/// edge, a neighbour with its front on the other side) keeps vertices of its own, and so do facets whose corners coincide.
struct OrganPatch {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< rows of `vertices`, in facet order
  std::vector<std::uint32_t> star_first;                ///< [vertices + 1]
  std::vector<std::uint32_t> star;                      ///< per vertex the facets about it, rising

  /// Area-weighted means at the vertices of values [facets][width]; plain means where no facet about a vertex has an area.
  std::vector<float> vertex_means(const float* values, std::size_t width, const float* area) const;
};

/// `organ` tells facets of different organs apart.
OrganPatch make_patch(const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& organ);

/// A patch as it stands in the scene. Where the map mirrors, corners 1 and 2 of its triangles change places.
struct PlacedPatch {
  const OrganPatch* patch = nullptr;
  Affine map;  ///< patch -> world
  bool mirrors = false;
  std::size_t first_facet = 0, first_vertex = 0;  ///< rows of the whole scene
  std::size_t copy = 0;                           ///< row of ResultGeometry::copies; their number for the ground

  std::size_t facets() const { return patch->triangles.size(); }
  std::array<std::uint32_t, 3> triangle(std::size_t t) const {
    const auto& v = patch->triangles[t];
    return mirrors ? std::array<std::uint32_t, 3>{v[0], v[2], v[1]} : v;
  }
};

/// The patches of a scene, each made once however often it stands there: memory is that of the distinct plants.
class OrganPatches {
 public:
  /// `ground_organ`: per facet of the ground, anything that tells its organs apart.
  OrganPatches(const ResultGeometry& geometry, const std::vector<std::uint32_t>& ground_organ);

  std::size_t vertex_count() const { return vertex_count_; }
  /// Vertices of one copy of a row of ResultGeometry::plants, and of the ground.
  std::size_t plant_vertices(std::size_t plant) const { return models_[model_of_[plant]].vertices; }
  std::size_t ground_vertices() const { return ground_.vertices; }

  /// Every patch of the scene in facet order, in batches of at least `facets` facets (the last may be smaller) without gaps.
  void for_each_batch(std::size_t facets, const std::function<void(std::span<const PlacedPatch>)>& batch) const;
  /// Patches of one copy, or of the ground (copy = number of copies), with rows of the whole scene.
  std::vector<PlacedPatch> of_copy(std::size_t copy) const;

 private:
  struct Part {
    const OrganPatch* patch;
    Affine placement;  ///< patch -> plant
    std::size_t first_facet, first_vertex;
  };
  struct Model {
    std::vector<Part> parts;
    std::size_t vertices = 0;
  };
  Model model_of(const Plant& plant);
  Model ground_of(const Mesh& ground, const std::vector<std::uint32_t>& organ);
  void place(std::size_t copy, std::size_t first_vertex, std::vector<PlacedPatch>& out) const;
  std::size_t copy_vertices(std::size_t copy) const;

  const ResultGeometry& geometry_;
  std::deque<OrganPatch> patches_;  // addresses stay
  std::vector<Model> models_;
  std::vector<std::size_t> model_of_;  ///< per row of ResultGeometry::plants
  Model ground_;
  std::vector<std::size_t> first_vertex_;  ///< per copy
  std::size_t vertex_count_ = 0;
};

}  // namespace sunfleck
