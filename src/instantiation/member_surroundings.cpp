#include "instantiation/member_surroundings.hpp"

#include <algorithm>
#include <limits>

namespace sunfleck {

MemberSurroundings::MemberSurroundings(const Members& members, const PlacedScene& placed)
    : members_(members), scene_(members.copies), maps_(members.maps), placed_(placed), rays_(members.copies) {
  Box extent;
  double organ = std::numeric_limits<double>::max();
  for (std::size_t m = 0; m < maps_.size(); ++m) {
    const auto& e = members.original_of(m).elements;
    extent.add(maps_[m].point(e.surface.origin));
    organ = std::min(organ, maps_[m].scale * std::sqrt(e.organ_area));
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
    end.target = RayEnd::ground_bit | (hit.index < members_.ground_facets ? hit.index : near_facet(hit.point));
    end.field = glm::dot(area_vector(scene_.ground[hit.index]), d) < 0 ? 0 : 1;
    return end;
  }
  const auto& map = maps_[hit.index];
  const auto& original = members_.original_of(hit.index);
  end.target = members_.is_far(hit.index) ? members_.stand_in[hit.index - members_.size()] : hit.index;
  end.field = original.coarse->field_at(map.point_back(hit.point - hit.image) - original.elements.surface.origin, map.direction_back(-d));
  return end;
}

/// The part of the near ground that stands for a point of the far one: the near field is laid out again and again.
std::uint32_t MemberSurroundings::near_facet(const Vec3& point) const {
  const auto& field = placed_.near_field;
  double x = (point.x - field[0]) / (field[2] - field[0]), y = (point.y - field[1]) / (field[3] - field[1]);
  x = (x - std::floor(x)) * placed_.near_cells[0];
  y = (y - std::floor(y)) * placed_.near_cells[1];
  const auto i = std::min(static_cast<std::uint32_t>(x), placed_.near_cells[0] - 1),
             j = std::min(static_cast<std::uint32_t>(y), placed_.near_cells[1] - 1);
  const std::uint32_t triangle = 2 * (j * placed_.near_cells[0] + i) + (x - i < y - j ? 1 : 0), first = members_.ground_parts[triangle],
                      parts = members_.ground_parts[triangle + 1] - first;
  return first + std::min(static_cast<std::uint32_t>((x - i) * parts), parts - 1);
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
  if (hit.kind != CopyHit::Kind::copy) return none;
  if (hit.index != m) return hit.index;
  // its own body, grazed within rounding, is met on the stretch itself; an image of it is met elsewhere
  const Vec3 from = surface.origin + Vec3{segment[0], segment[1], segment[2]};
  const Vec3 along = Vec3{segment[3] - segment[0], segment[4] - segment[1], segment[5] - segment[2]};
  const Vec3 off = maps_[m].point_back(hit.point - hit.image) - from;
  const Vec3 beside = off - along * (glm::dot(off, along) / glm::dot(along, along));
  return glm::length(beside) * maps_[m].scale < 4 * skip_ ? none : m;
}

RayEnd MemberSurroundings::look_from_ground(const Vec3& point, const Vec3& d) const {
  return end_of(rays_.first_hit(point, d, 0.0), d);
}

bool MemberSurroundings::hidden_from_ground(const Vec3& point, const Vec3& d) const {
  return rays_.occluded(point, d, 0.0, std::numeric_limits<double>::infinity());
}

}  // namespace sunfleck
