// What copies see of each other, of the ground and of the sky.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/core/similarity.hpp>
#include <sunfleck/scene/scene.hpp>
#include <sunfleck/visibility/copies.hpp>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Where a ray from a copy or the ground ends: in an outgoing field of a member, on a side of a facet of the ground, or in the sky.
struct RayEnd {
  static constexpr std::uint32_t sky = 0xffffffffu, ground_bit = 0x80000000u, mirrored_bit = 0x80000000u;
  std::uint32_t target = sky;  ///< member; or ground_bit | facet
  /// Of the member; of the ground: 0 front, 1 back. With the mirrored_bit: of the member on the ground that looks down, which sees there
  /// what it sends itself, times the ground's reflectance.
  std::uint32_t field = 0;

  bool is_sky() const { return target == sky; }
  bool is_ground() const { return !is_sky() && (target & ground_bit); }
  bool is_mirrored() const { return !is_sky() && (field & mirrored_bit); }
  std::uint32_t facet() const { return target & ~ground_bit; }
};

/// Rays through a scene of members.
class MemberSurroundings {
 public:
  /// `members` must outlive it.
  explicit MemberSurroundings(const Members& members);

  /// From a point of member `m`, given in its original's surface coordinates, along the world direction `d`.
  RayEnd look(std::uint32_t m, const std::array<float, 3>& point, const Vec3& d) const;
  /// Which other member, or image of a member, stands between two points of member `m` (in its surface coordinates) that see each other
  /// inside its original; none = nothing, m = an image of itself, the_ground = the ground.
  static constexpr std::uint32_t none = 0xffffffffu, the_ground = 0xfffffffeu;
  std::uint32_t stands_between(std::uint32_t m, const std::array<float, 6>& segment) const;
  /// The member whose inner face is met from a point of member `m` along the world direction `d`: one that stands behind the point as well,
  /// so that its field, which tells what leaves it, is not what is met. none = none is.
  std::uint32_t inner_face(std::uint32_t m, const std::array<float, 3>& point, const Vec3& d) const;
  /// From a world point of a facet of the ground, lifted off the side that looks by ground_lift(): below what lies there.
  RayEnd look_from_ground(const Vec3& point, const Vec3& d) const;
  /// Is the sun hidden from such a point?
  bool hidden_from_ground(const Vec3& point, const Vec3& d) const;
  double ground_lift() const { return 0.5 * scene_.ground_gap; }  ///< [m]
  /// Rays no longer meet some members, or meet them again. Not while rays are asked.
  void set_hidden(const std::vector<std::uint32_t>& members, bool hidden) { rays_.set_hidden(members, hidden); }
  std::size_t bytes() const { return rays_.bytes(); }

 private:
  RayEnd end_of(const CopyHit& hit, const Vec3& d) const;
  /// How far along a ray the box about a member, moved by `image`, ends; negative where the ray meets it nowhere.
  double way_through(std::uint32_t m, const Vec3& image, const Vec3& from, const Vec3& d) const;

  const Members& members_;
  const CopyScene& scene_;
  const std::vector<Similarity>& maps_;
  CopyRays rays_;
  double skip_ = 0;  ///< [m] rays begin so far from where they start
};

}  // namespace sunfleck
