// Structures of a plant with all below them: facets, moments, derived parameters.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Sums over the facets of a structure and all below it, in the plant's frame. Area weights are one-sided areas.
struct Moments {
  double area = 0;    ///< [m^2]
  Vec3 first{0.0};    ///< sum of area times centroid [m^3]
  double second = 0;  ///< sum of area times squared distance of the centroid from the origin [m^4]
  Mat3 normals{0.0};  ///< sum of area times n n^T [m^2]
  double edges = 0;   ///< sum of the lengths of all edges [m]
  std::uint64_t facets = 0;
  std::uint64_t optics = 0;  ///< hash of rows of optics and counts, in facet order
  std::uint64_t leaves = 0;  ///< structures of type leaf
  Box bounds;
  std::vector<std::uint32_t> materials;  ///< rows of optics used, rising

  Vec3 centroid() const { return area > 0 ? first / area : Vec3{0.0}; }
  /// Root mean squared distance of facets from the centroid [m].
  double gyration() const;
};

class Subtrees {
 public:
  explicit Subtrees(const PlantEntry& entry);

  const Plant& plant() const { return *entry_->plant; }
  const PlantEntry& entry() const { return *entry_; }
  const Moments& moments(std::uint32_t structure) const { return moments_[structure]; }
  /// Rigid frame of a structure -> plant frame, its axis along +z: its own, or, where it has no shape and only its parent's frame (OPF
  /// gives axes no place of their own), that of its first part.
  const Affine& frame(std::uint32_t structure) const { return frames_[structure]; }
  /// Facets of a structure and all below it in the plant's frame, by structure (depth first), then in the order of the file.
  std::vector<Triangle> facets(std::uint32_t structure) const;
  /// The same, and the row of Scene::optics of each.
  std::vector<Triangle> facets(std::uint32_t structure, std::vector<std::uint32_t>& optics) const;

 private:
  template <class Call>
  void each_shape(std::uint32_t structure, Call&& call) const;

  const PlantEntry* entry_;
  std::vector<std::uint32_t> begin_, end_;  ///< [structures] range of order_ that is the structure and all below it
  std::vector<std::uint32_t> order_;        ///< structures depth first
  std::vector<std::uint32_t> first_shape_;  ///< [structures + 1] rows of shape_order_
  std::vector<std::uint32_t> shape_order_;  ///< shapes by their structure
  std::vector<Moments> moments_;
  std::vector<Affine> frames_;
};

}  // namespace sunfleck
