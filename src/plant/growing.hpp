// What both growth programs share: placing structures and shapes, shared meshes, small rotations.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/plant/plant.hpp>
#include <sunfleck/plant/species.hpp>

namespace sunfleck {

inline constexpr std::size_t node_limit = 4'000'000;  ///< a species whose buds multiply without end stops here
inline constexpr double clearance_m = 0.005;          ///< nothing grows lower above the ground

inline constexpr double radians(double degrees) {
  return degrees * 0.017453292519943295;
}

inline constexpr double mantle_gap = 1.15;  ///< leaves start so many radii from an axis, so that they do not cut its mantle

/// Uniform in [-1, 1).
inline double spread(RandomStream& random) {
  return 2 * random.next() - 1;
}

/// Rotation about a unit axis, counter-clockwise seen from its tip.
Mat3 rotation(const Vec3& axis, double angle_rad);

/// Right-handed frame whose z is the unit vector `along` and whose y is as near to `front` as can be.
Mat3 organ_frame(const Vec3& along, const Vec3& front);

/// Turns the unit vector d by at most angle_rad (>= 0) towards the unit vector `to`.
Vec3 turned_towards(const Vec3& d, const Vec3& to, double angle_rad);

/// Rotates a frame along with its axis: the smallest rotation that takes the frame's z to the unit vector d.
Mat3 carried(const Mat3& frame, const Vec3& d);

/// A plant in the making. Structures and shapes must be added depth first.
class PlantBuilder {
 public:
  explicit PlantBuilder(const Species& species);

  std::uint32_t open(std::uint32_t parent, const std::string& type, const Affine& frame, std::int64_t order, std::int64_t physiological_age,
                     double length_m);
  void shape(std::uint32_t structure, std::uint32_t mesh, const std::string& material, const Affine& placement);
  std::uint32_t add_mesh(Mesh mesh);
  /// A mantle between two radii, drawn with the shared frustum of the nearest ratio in steps of 0.1.
  void internode(std::uint32_t structure, const std::string& material, std::int64_t sides, const Vec3& from, const Vec3& to,
                 const Mat3& frame, double radius_from, double radius_to);
  /// Lowest z of a mesh under a placement [m].
  double lowest(std::uint32_t mesh, const Affine& placement) const;

  /// Sets leaf_count and the plant's length, checks, and hands the plant over.
  Plant finish();

 private:
  Plant plant_;
  std::uint32_t leaf_count_, order_, physiological_age_, length_;
  std::map<std::pair<std::int64_t, int>, std::uint32_t> frusta_;
};

Plant grow_tree(const Species& species, const TreeGrowth& growth, double age, std::uint64_t seed);
Plant grow_cereal(const Species& species, const CerealGrowth& growth, double age, std::uint64_t seed);

/// Throws InputError: the plant would have more nodes than node_limit.
[[noreturn]] void too_many_nodes(const Species& species, double age);

}  // namespace sunfleck
