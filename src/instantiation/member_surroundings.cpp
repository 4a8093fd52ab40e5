#include "instantiation/member_surroundings.hpp"

#include <algorithm>
#include <limits>

namespace sunfleck {

MemberSurroundings::MemberSurroundings(const Members& members)
    : members_(members), scene_(members.copies), maps_(members.maps), rays_(members.copies) {
  Box extent;
  double organ = std::numeric_limits<double>::max();
  for (std::size_t m = 0; m < maps_.size(); ++m) {
    const auto& e = members.original_of(m).elements;
    extent.add(maps_[m].point(e.surface.origin));
    organ = std::min(organ, maps_[m].scale * std::sqrt(e.patch_area));
  }
  for (const auto& t : scene_.ground)
    for (const auto& p : t) extent.add(p);
  const Vec3 size = extent.size();
  // single precision resolves 1e-7 of the scene; a hundredth of an organ hides nothing
  skip_ = std::max(2e-6 * std::max({size.x, size.y, size.z}), maps_.empty() ? 0.0 : 1e-3 * organ);
}

RayEnd MemberSurroundings::end_of(const CopyHit& hit, const Vec3& d) const {
  RayEnd end;
  if (hit.kind == CopyHit::Kind::nothing) return end;
  if (hit.kind == CopyHit::Kind::ground) {
    end.target = RayEnd::ground_bit | hit.index;
    end.field = glm::dot(area_vector(scene_.ground[hit.index]), d) < 0 ? 0 : 1;
    return end;
  }
  const auto& map = maps_[hit.index];
  const auto& original = members_.original_of(hit.index);
  end.target = members_.is_far(hit.index) ? members_.stand_in[hit.index - members_.size()] : hit.index;
  end.field = original.coarse->field_at(map.point_back(hit.point - hit.image) - original.elements.surface.origin, map.direction_back(-d));
  return end;
}

RayEnd MemberSurroundings::look(std::uint32_t m, const std::array<float, 3>& point, const Vec3& d) const {
  const auto& surface = members_.original_of(m).elements.surface;
  const Vec3 from = maps_[m].point(surface.origin + Vec3{point[0], point[1], point[2]});
  if (const CopyHit under = rays_.first_ground(from, d, skip_); under.kind == CopyHit::Kind::ground) {  // it lies there
    if (m >= members_.size()) return end_of(under, d);
    const auto field = members_.original_of(m).coarse->field_at(Vec3{point[0], point[1], point[2]}, maps_[m].direction_back(d));
    return {m, field | RayEnd::mirrored_bit};
  }
  return end_of(rays_.first_hit(from, d, skip_), d);
}

std::uint32_t MemberSurroundings::stands_between(std::uint32_t m, const std::array<float, 6>& segment) const {
  const auto& surface = members_.original_of(m).elements.surface;
  const Vec3 a = maps_[m].point(surface.origin + Vec3{segment[0], segment[1], segment[2]});
  const Vec3 b = maps_[m].point(surface.origin + Vec3{segment[3], segment[4], segment[5]});
  const double length = glm::length(b - a);
  if (length <= 2 * skip_) return none;
  const CopyHit hit = rays_.first_hit(a, (b - a) / length, skip_, length - skip_);
  if (hit.kind == CopyHit::Kind::ground) return the_ground;
  if (hit.kind != CopyHit::Kind::copy) return none;
  if (hit.index != m) return hit.index;
  // its own body, grazed within rounding, is met on the stretch itself; an image of it is met elsewhere
  const Vec3 from = surface.origin + Vec3{segment[0], segment[1], segment[2]};
  const Vec3 along = Vec3{segment[3] - segment[0], segment[4] - segment[1], segment[5] - segment[2]};
  const Vec3 off = maps_[m].point_back(hit.point - hit.image) - from;
  const Vec3 beside = off - along * (glm::dot(off, along) / glm::dot(along, along));
  return glm::length(beside) * maps_[m].scale < 4 * skip_ ? none : m;
}

double MemberSurroundings::way_through(std::uint32_t m, const Vec3& image, const Vec3& from, const Vec3& d) const {
  const auto& surface = members_.original_of(m).elements.surface;
  const Vec3 p = maps_[m].point_back(from - image) - surface.origin, along = maps_[m].direction_back(d) / maps_[m].scale;
  double first = 0, last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = surface.focus.low[axis] - p[axis], high = surface.focus.high[axis] - p[axis];
    if (along[axis] == 0.0) {
      if (low > 0 || high < 0) return -1;
      continue;
    }
    first = std::max(first, std::min(low / along[axis], high / along[axis]));
    last = std::min(last, std::max(low / along[axis], high / along[axis]));
  }
  return first <= last ? last : -1;
}

std::uint32_t MemberSurroundings::inner_face(std::uint32_t m, const std::array<float, 3>& point, const Vec3& d) const {
  constexpr int most_hits = 1000;
  const auto& surface = members_.original_of(m).elements.surface;
  const Vec3 from = maps_[m].point(surface.origin + Vec3{point[0], point[1], point[2]});
  const CopyHit met = rays_.first_hit(from, d, skip_);
  if (met.kind != CopyHit::Kind::copy) return none;
  const auto image_of = [](const Vec3& at, const CopyHit& hit) { return at - (hit.point - hit.image); };  // without wraps
  const Vec3 image = image_of(from + met.distance * d, met);
  if (met.index == m && glm::length(image) <= 4 * skip_) return none;
  const double way = way_through(met.index, image, from, -d);
  double gone = 0;
  for (int k = 0; k < most_hits && gone < way; ++k) {
    const CopyHit behind = rays_.first_hit(from - gone * d, -d, skip_, way - gone + skip_);
    if (behind.kind != CopyHit::Kind::copy) return none;
    gone += behind.distance;
    if (behind.index == met.index && glm::length(image_of(from - gone * d, behind) - image) <= 4 * skip_) return met.index;
  }
  return none;
}

RayEnd MemberSurroundings::look_from_ground(const Vec3& point, const Vec3& d) const {
  return end_of(rays_.first_hit(point, d, 0.0), d);
}

bool MemberSurroundings::hidden_from_ground(const Vec3& point, const Vec3& d) const {
  return rays_.occluded(point, d, 0.0, std::numeric_limits<double>::infinity());
}

}  // namespace sunfleck
