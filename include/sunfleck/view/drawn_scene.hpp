// A scene to draw that is never written out: each mesh once, its copies as maps, values looked up by facet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

/// Geometry of a result with what pictures ask of a facet. Memory: the distinct meshes, and about 200 bytes a copy; nothing per facet.
class DrawnScene {
 public:
  /// A result as it was solved. Without `ground`, plants only. Works for files that keep organs only. Throws InputError where the file
  /// holds no geometry, where its organs do not fit it, or where nothing is left to draw.
  explicit DrawnScene(const Result& result, bool ground = true);
  /// A scene in memory, its copies as they are placed.
  DrawnScene(const Scene& scene, const PlacedScene& placed);
  /// A scene in memory, as one mesh.
  explicit DrawnScene(const FacetScene& scene);

  /// Where a facet is: copies.size() stands for the ground, whose shape is 0.
  struct Place {
    std::uint32_t copy = 0, shape = 0;
    std::size_t triangle = 0;  ///< of the shape
  };

  const ResultGeometry& geometry() const { return geometry_; }
  const std::vector<Optics>& materials() const { return materials_; }
  std::size_t size() const { return geometry_.facet_count(); }
  std::size_t plant_facets() const { return geometry_.plant_facets; }
  bool is_ground(const Place& place) const { return place.copy == geometry_.copies.size(); }

  Place place(std::size_t facet) const;
  /// First facet of the run of facets (shape, or ground) that a facet belongs to, and their number.
  std::size_t run_begin(const Place& place) const;
  std::size_t run_length(const Place& place) const;
  /// World coordinates [m], fronts as solved.
  Triangle corners(const Place& place) const;
  /// True if corners() swaps the mesh's last two corners, to keep fronts under a mirroring map.
  bool swapped(const Place& place) const;
  std::uint32_t optics(const Place& place) const;
  std::uint32_t organ(const Place& place) const;
  /// "ground" for the ground.
  const std::string& organ_type(const Place& place) const;
  /// Number of structures that hold the facet's organ: 0 where it is the plant itself; of the ground 0.
  std::uint32_t level(const Place& place) const;

  /// Calls part(place of the first, number of facets, position in the range) for each run of facets in [first, first + count).
  template <class Part>
  void each_run(std::size_t first, std::size_t count, Part part) const {
    for (std::size_t at = first; at < first + count;) {
      const Place p = place(at);
      const std::size_t n = std::min(first + count - at, run_length(p) - p.triangle);
      part(p, n, at - first);
      at += n;
    }
  }

  /// Of all plants, or of the ground where there are none; around outline(), so 0.5 % of a plant's size may be missing.
  const Box& bounds() const { return bounds_; }
  /// Of all that is drawn, ground included.
  const Box& all_bounds() const { return all_bounds_; }
  /// Lowest point of the ground [m].
  double ground_height() const { return ground_box_.low.z; }
  /// Points on the outline of the plants (of the ground where there are none), enough to frame them: the farthest points of each plant in
  /// up to 256 directions, so that none sticks out of their hull by more than about 0.5 % of the plant's size.
  const std::vector<Vec3>& outline() const { return outline_; }

 private:
  /// `organs`: of the scene; `file` for errors.
  void number_organs(std::uint64_t organs, const std::string& file);
  void measure();

  ResultGeometry geometry_;
  std::vector<Optics> materials_;
  std::vector<std::vector<std::uint32_t>> shape_organ_;  ///< [plants][shapes] organ within the copy
  std::vector<std::uint32_t> copy_organ_;                ///< [copies] first organ
  std::uint32_t ground_organ_ = 0;
  bool ground_in_one_ = false;  ///< one organ, else one for each two facets
  Box bounds_, all_bounds_, ground_box_;
  std::vector<Vec3> outline_;
};

}  // namespace sunfleck
