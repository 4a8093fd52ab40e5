#include "instantiation/surroundings.hpp"

#include <algorithm>
#include <limits>

namespace sunfleck {

Surroundings::Surroundings(const CopyScene& scene, const std::vector<Similarity>& maps, const std::vector<OriginalLight>& originals)
    : scene_(scene), maps_(maps), originals_(originals), rays_(scene) {
  Box extent;
  double organ = std::numeric_limits<double>::max();
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const auto& e = originals[scene.copies[m].surface].elements;
    const Vec3 at = maps[m].point(e.surface.origin);
    extent.add(at);
    organ = std::min(organ, maps[m].scale * std::sqrt(e.organ_area));
  }
  for (const auto& t : scene.ground)
    for (const auto& p : t) extent.add(p);
  const Vec3 size = extent.size();
  // single precision resolves 1e-7 of the scene; a hundredth of an organ hides nothing
  skip_ = std::max(2e-6 * std::max({size.x, size.y, size.z}), maps.empty() ? 0.0 : 1e-3 * organ);
}

RayEnd Surroundings::end_of(const CopyHit& hit, const Vec3& d) const {
  RayEnd end;
  if (hit.kind == CopyHit::Kind::nothing) return end;
  if (hit.kind == CopyHit::Kind::ground) {
    end.target = RayEnd::ground_bit | hit.index;
    end.field = glm::dot(area_vector(scene_.ground[hit.index]), d) < 0 ? 0 : 1;
    return end;
  }
  const auto& map = maps_[hit.index];
  const auto& original = originals_[scene_.copies[hit.index].surface];
  end.target = hit.index;
  end.field = original.coarse->field_at(map.point_back(hit.point - hit.image) - original.elements.surface.origin, map.direction_back(-d));
  return end;
}

RayEnd Surroundings::look(std::uint32_t m, const std::array<float, 3>& point, const Vec3& d) const {
  const auto& surface = originals_[scene_.copies[m].surface].elements.surface;
  const Vec3 from = maps_[m].point(surface.origin + Vec3{point[0], point[1], point[2]});
  return end_of(rays_.first_hit(from, d, skip_), d);
}

std::uint32_t Surroundings::stands_between(std::uint32_t m, const std::array<float, 6>& segment) const {
  const auto& surface = originals_[scene_.copies[m].surface].elements.surface;
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

RayEnd Surroundings::look_from_ground(const Vec3& point, const Vec3& d) const {
  return end_of(rays_.first_hit(point, d, skip_), d);
}

bool Surroundings::hidden(const Vec3& point, const Vec3& d) const {
  return rays_.occluded(point, d, skip_, std::numeric_limits<double>::infinity());
}

}  // namespace sunfleck
