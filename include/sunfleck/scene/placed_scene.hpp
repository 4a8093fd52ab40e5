// Which copies a scene holds and which rows of the result are theirs, without writing them out.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/scene/depth.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Every facet of one plant in the plant's own frame, in file order; n facets, m organs.
struct PlantFacets {
  std::vector<Triangle> corners;               ///< [n] plant frame [m], fronts as in the file
  std::vector<std::uint32_t> optics;           ///< [n] row of Scene::optics
  std::vector<std::uint32_t> organ;            ///< [n] row of the plant's organs
  std::vector<std::uint32_t> organ_structure;  ///< [m] row of Plant::structures
  std::vector<std::uint32_t> shape_first;      ///< [shapes + 1] first facet of each shape
  std::size_t size() const { return corners.size(); }
  std::size_t organs() const { return organ_structure.size(); }
};

/// Writes out one plant once. Where a copy's map mirrors, corners 1 and 2 of its facets are swapped, so that fronts stay fronts.
PlantFacets plant_facets(const PlantEntry& entry);

/// Corners of a facet of a copy in the world [m].
inline Triangle placed_corners(const Triangle& corners, const Affine& map, bool mirrors) {
  Triangle c{map.point(corners[0]), map.point(corners[1]), map.point(corners[2])};
  if (mirrors) std::swap(c[1], c[2]);
  return c;
}

/// The name that the result gives an organ of a plant.
std::string organ_name(const Plant& plant, std::uint32_t structure);

/// A copy of a plant in the world.
struct PlacedCopy {
  std::uint32_t plant = 0;        ///< row of Scene::plants
  Affine map;                     ///< plant frame -> world
  std::uint64_t first_facet = 0;  ///< row of the result
  std::uint64_t first_organ = 0;  ///< row of the result
};

/// A placement that is not opened, with all that it holds: a plant, a group, or a structure within a plant.
struct ClosedStructure {
  std::string path;
  bool is_group = false;
  std::uint32_t index = 0;      ///< row of Scene::plants or Scene::groups
  std::uint32_t structure = 0;  ///< row of Plant::structures
  Affine map;                   ///< frame of the plant or group -> world
  bool solved = true;           ///< false if some of its copies are too far from what is opened: others like them stand for their light
};

/// A copy of a plant that is not opened.
struct ClosedCopy {
  std::uint32_t plant = 0;
  Affine map;
  std::uint32_t structure = 0;  ///< row of PlacedScene::closed
};

/// Facets of the ground in their order, world [m], and the organs that they make: cells of two facets of a flat one, made on request so
/// that they cost nothing; the whole of a mesh.
class GroundFacets {
 public:
  GroundFacets() = default;
  /// A mesh: one organ, "ground".
  explicit GroundFacets(std::vector<Triangle> facets) : facets_(std::move(facets)), size_(facets_.size()) {}
  /// Two triangles a cell, rows along x from the lowest x and y, front upwards. `field`: x_low, y_low, x_high, y_high [m].
  GroundFacets(const std::array<double, 4>& field, const std::array<std::uint32_t, 2>& cells, double height)
      : field_(field), cells_(cells), height_(height), size_(std::size_t{2} * cells[0] * cells[1]) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Triangle operator[](std::size_t facet) const;
  std::vector<Triangle> written_out() const;

  /// Cells along x and y of a flat one; 0 of a mesh.
  const std::array<std::uint32_t, 2>& cells() const { return cells_; }
  std::size_t organs() const { return flat() ? size_ / 2 : std::min<std::size_t>(size_, 1); }
  std::uint32_t organ(std::size_t facet) const { return flat() ? static_cast<std::uint32_t>(facet / 2) : 0; }
  /// First of the facets of an organ.
  std::size_t first_facet(std::size_t organ) const { return flat() ? 2 * organ : 0; }
  std::string organ_name(std::size_t organ) const;

 private:
  bool flat() const { return cells_[0] > 0; }

  std::vector<Triangle> facets_;
  std::array<double, 4> field_{};
  std::array<std::uint32_t, 2> cells_{0, 0};
  double height_ = 0;
  std::size_t size_ = 0;
};

/// Rows of facets and organs in the order of the result file: plants in scene order (placements in their order), groups in scene order
/// with their placements, members in theirs; then ground cells. Memory: some 150 bytes a copy, and what a mesh of the ground holds.
struct PlacedScene {
  std::vector<PlacedCopy> copies;
  std::vector<std::string> paths;           ///< per copy: "tile[3]/coffee[1]"
  std::vector<std::uint64_t> plant_facets;  ///< per row of Scene::plants: facets of one copy
  std::vector<std::uint64_t> plant_organs;  ///< per row of Scene::plants: organs of one copy
  GroundFacets ground;
  std::uint64_t first_ground_facet = 0, first_ground_organ = 0;
  std::uint64_t facets = 0, organs = 0;  ///< in all

  Depth depth;  ///< as place() was asked
  // What it leaves closed (`only`, `stop_at` at whole plants and groups): no rows. The ground has rows unless `only` is given.
  std::vector<ClosedStructure> closed;
  std::vector<ClosedCopy> near;       ///< copies in which light is solved: named by `stop_at`, or near what is opened or in its sun
  std::vector<ClosedCopy> far;        ///< copies that rays meet; light that leaves them is that of copies alike that are solved
  std::vector<Triangle> near_ground;  ///< with `only`: the ground about what is opened, world [m]
  std::vector<Triangle> far_ground;   ///< the rest of it, as far as rays matter, in larger pieces
  bool partial = false;               ///< `only` is given
  double share = 1;                   ///< of all copies that are listed: less where place() was given a limit

  /// Copies in which light is solved: those with rows, then `near`; `far` follows them.
  std::size_t solved() const { return copies.size() + near.size(); }
  std::uint64_t solved_facets() const {
    std::uint64_t n = facets;
    for (const auto& c : near) n += plant_facets[c.plant];
    return n;
  }
  std::size_t all_copies() const { return solved() + far.size(); }
  std::uint32_t plant_of(std::size_t copy) const { return copy < copies.size() ? copies[copy].plant : closed_copy(copy).plant; }
  const Affine& map_of(std::size_t copy) const { return copy < copies.size() ? copies[copy].map : closed_copy(copy).map; }
  /// For copies beyond those with rows.
  const ClosedCopy& closed_copy(std::size_t copy) const { return copy < solved() ? near[copy - copies.size()] : far[copy - solved()]; }
};

/// Lays out a scene that has passed check_scene(): what `depth` says is opened has rows; of the rest, copies near what is opened are
/// listed, and groups farther away are never entered, so that 10^8 copies cost nothing. Copies count as near within two plant sizes, or
/// if they stand between what is opened and a sun; farther ones are listed as far as 50 plant heights, at most 50,000. Scenes of at most
/// 2 million facets and periodic ones are near as a whole. Throws InputError if there is no facet, more copies than memory holds, or a
/// pattern of `only` that meets nothing.
/// `most_copies`: of scenes with more, as large a part of every plant's and group's placements is listed, for estimates; `facets` and
/// `organs` count that part. Not with `only` and `stop_at`.
PlacedScene place(const Scene& scene, const Depth& depth = {}, std::uint64_t most_copies = std::numeric_limits<std::uint64_t>::max());

/// The same scene with rows for what is near and far as well, after those of what is opened, and, with `only`, for the ground about it.
PlacedScene with_surroundings(const PlacedScene& placed);

}  // namespace sunfleck
