#include <sunfleck/visibility/copies.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "visibility/embree_scene.hpp"

namespace sunfleck {

namespace {

constexpr double least_slope_among_copies = 1e-4;  // of rays in periodic scenes
constexpr double most_cells_wrapped = 1e6;         // that a ray is wrapped through

/// Corners of a surface's box, where a copy of it stands.
template <class Visit>
void each_corner(const Surface& s, const Affine& map, Visit&& visit) {
  for (int i = 0; i < 8; ++i)
    visit(map.point(s.origin + Vec3{i & 1 ? s.focus.high.x : s.focus.low.x, i & 2 ? s.focus.high.y : s.focus.low.y,
                                    i & 4 ? s.focus.high.z : s.focus.low.z}));
}

}  // namespace

struct CopyRays::Impl {
  explicit Impl(const CopyScene& s) : scene(s) {
    box = extent();
    centre = box.empty() ? Vec3{0.0} : box.centre();
    if (scene.periodic) {
      find_heights();
      centre.x = scene.periodic->x_low;
      centre.y = scene.periodic->y_low;
    }
    top = device.new_scene(RTC_SCENE_FLAG_COMPACT);
    for (const auto* surface : scene.surfaces) parts.push_back(surface_scene(*surface));
    for (std::uint32_t c = 0; c < scene.copies.size(); ++c) add_copy(c);
    if (!scene.ground.empty()) add_ground();
    device.commit(top.get());
    device.check(fmt::format("{} copies and {} facets of the ground", instance_copy.size(), scene.ground.size()));
  }

  Box extent() const {
    Box b;
    for (const auto& copy : scene.copies)
      if (!scene.surfaces[copy.surface]->focus.empty()) b.add(copy_bounds(*scene.surfaces[copy.surface], copy.map));
    for (const auto& t : scene.ground)
      for (const auto& p : t) b.add(p);
    return b;
  }

  /// Above the plane that the scene repeats along.
  void find_heights() {
    Box b;
    const auto add = [&](const Vec3& p) { b.add(scene.periodic->levelled(p)); };
    for (const auto& copy : scene.copies) {
      const Surface& s = *scene.surfaces[copy.surface];
      if (!s.focus.empty()) each_corner(s, copy.map, add);
    }
    for (const auto& t : scene.ground)
      for (const auto& p : t) add(p);
    if (!b.empty()) heights = {b.low.z, b.high.z};
  }

  EmbreeScenePointer surface_scene(const Surface& s) {
    EmbreeScenePointer out = device.new_scene(RTC_SCENE_FLAG_COMPACT);
    EmbreeMesh triangles;
    for (std::size_t t = 0; t < s.size(); ++t) {
      Triangle corners;
      for (std::size_t k = 0; k < 9; ++k) corners[k / 3][static_cast<int>(k % 3)] = s.corner[k][t];
      triangles.add(corners, s.split[t] != 0);
    }
    triangles.attach(device, out.get(), 0);
    device.commit(out.get());
    return out;
  }

  void add_instance(std::uint32_t c, const Vec3& moved) {
    const auto& copy = scene.copies[c];
    const Vec3 move = copy.map.point(scene.surfaces[copy.surface]->origin) + moved - centre;
    attach_instance(device, top.get(), static_cast<unsigned>(instance_copy.size()), parts[copy.surface].get(), copy.map.linear, move);
    instance_copy.push_back(c);
    instance_moved.push_back(moved);
  }

  /// In periodic scenes every image whose box reaches into the cell stands in it.
  void add_copy(std::uint32_t c) {
    const auto& s = *scene.surfaces[scene.copies[c].surface];
    if (s.focus.empty()) return;
    if (!scene.periodic) return add_instance(c, Vec3{0.0});
    const auto& cell = *scene.periodic;
    const Box b = copy_bounds(s, scene.copies[c].map);
    const auto low_x = std::ceil((cell.x_low - b.high.x) / cell.width()), high_x = std::floor((cell.x_high - b.low.x) / cell.width());
    const auto low_y = std::ceil((cell.y_low - b.high.y) / cell.depth()), high_y = std::floor((cell.y_high - b.low.y) / cell.depth());
    const double most = 4096 + 64.0 * static_cast<double>(scene.copies.size());
    if (static_cast<double>(instance_copy.size()) + (high_x - low_x + 1) * (high_y - low_y + 1) > most)
      throw InputError("domain.periodic", fmt::format("plants that reach over more than {:.0f} cells", most),
                       "a cell of about the plants' size, all in metres, or method clustering, flat, direct or reference");
    for (double y = low_y; y <= high_y; ++y)
      for (double x = low_x; x <= high_x; ++x) add_instance(c, cell.image(x, y));
  }

  void add_ground() {
    EmbreeTriangles triangles(device, scene.ground.size());
    for (std::size_t i = 0; i < scene.ground.size(); ++i) {
      const Triangle& t = scene.ground[i];
      triangles.set(i, {t[0] - centre, t[1] - centre, t[2] - centre});
    }
    triangles.attach(top.get(), static_cast<unsigned>(instance_copy.size()));
    for (const auto& t : scene.ground)
      for (const auto& p : t) level = level && p.z == scene.ground[0][0].z;
    if (level) return;
    ground = device.new_scene(RTC_SCENE_FLAG_COMPACT);
    triangles.attach(ground.get(), 0);
    device.commit(ground.get());
  }

  /// The first thing between `from` and `to` along the ray; false if there is none.
  static bool segment(RTCScene in, const Vec3& origin, const Vec3& d, double from, double to, RTCRayHit& r) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    return embree_meets(in, context, embree_ray(origin, d, from, to), r);
  }

  CopyHit found(const RTCRayHit& r, const Vec3& point, double distance) const {
    CopyHit hit;
    hit.distance = distance;
    hit.point = point + centre;
    if (r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) {
      hit.kind = CopyHit::Kind::ground;
      hit.index = r.hit.primID;
    } else {
      hit.kind = CopyHit::Kind::copy;
      hit.index = instance_copy[r.hit.instID[0]];
      hit.image = instance_moved[r.hit.instID[0]];
    }
    return hit;
  }

  CopyHit trace(RTCScene in, Vec3 p, Vec3 d, double skip, double range) const {
    p -= centre;
    RTCRayHit r;
    if (!scene.periodic) {
      if (!segment(in, p, d, skip, range, r)) return {};
      return found(r, p + static_cast<double>(r.ray.tfar) * d, static_cast<double>(r.ray.tfar));
    }
    const PeriodicCell& cell = *scene.periodic;
    double gain = cell.above(d);
    if (std::fabs(gain) < least_slope_among_copies) {
      const double least = gain < 0 ? -least_slope_among_copies : least_slope_among_copies;
      d = glm::normalize(Vec3{d.x, d.y, d.z + (least - gain)});
      gain = cell.above(d);
    }
    const double width = scene.periodic->width(), depth = scene.periodic->depth();
    const double slack = 1e-6 * std::max({width, depth, box.size().z});  // level ground is at the very end, in single precision
    const double low = heights[0] - cell.above(centre) - slack, high = heights[1] - cell.above(centre) + slack;
    p -= cell.image(std::floor(p.x / width), std::floor(p.y / depth));
    double travelled = 0, from = skip;
    for (double cells = 0; cells < most_cells_wrapped; ++cells) {
      const double to_x = d.x > 0 ? (width - p.x) / d.x : d.x < 0 ? -p.x / d.x : std::numeric_limits<double>::infinity();
      const double to_y = d.y > 0 ? (depth - p.y) / d.y : d.y < 0 ? -p.y / d.y : std::numeric_limits<double>::infinity();
      const double to_end = (gain > 0 ? high - cell.above(p) : low - cell.above(p)) / gain;
      const double step = std::max(0.0, std::min(to_x, to_y)), overlap = 1e-6 * (1.0 + step);
      const double to = std::min({step + overlap, to_end + overlap, range - travelled});
      if (to > from && segment(in, p, d, from, to, r))
        return found(r, p + static_cast<double>(r.ray.tfar) * d, travelled + static_cast<double>(r.ray.tfar));
      if (to_end <= step || travelled + step >= range) return {};
      p += step * d;
      if (to_x <= to_y) p -= cell.image(d.x > 0 ? 1.0 : -1.0, 0.0);
      if (to_y <= to_x) p -= cell.image(0.0, d.y > 0 ? 1.0 : -1.0);
      p.x = std::clamp(p.x, 0.0, width);
      p.y = std::clamp(p.y, 0.0, depth);
      travelled += step;
      from = std::max(0.0, from - step);
    }
    return {};
  }

  const CopyScene& scene;
  EmbreeDevice device{EmbreeDevice::Trees::same_for_any_threads};
  std::vector<EmbreeScenePointer> parts;
  EmbreeScenePointer top;
  EmbreeScenePointer ground;  ///< alone, if it is not level
  bool level = true;
  Vec3 centre{0.0};
  Box box;
  std::array<double, 2> heights{};  ///< the lowest and the highest, in periodic scenes
  std::vector<std::uint32_t> instance_copy;
  std::vector<Vec3> instance_moved;
};

Box copy_bounds(const Surface& s, const Affine& map) {
  Box b;
  if (s.focus.empty()) return b;
  each_corner(s, map, [&](const Vec3& p) { b.add(p); });
  return b;
}

CopyRays::CopyRays(const CopyScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
CopyRays::~CopyRays() = default;

CopyHit CopyRays::first_hit(const Vec3& origin, const Vec3& direction, double skip, double range) const {
  return impl_->trace(impl_->top.get(), origin, direction, skip, range);
}

CopyHit CopyRays::first_ground(const Vec3& origin, const Vec3& direction, double range) const {
  if (impl_->ground) return impl_->trace(impl_->ground.get(), origin, direction, 0.0, range);
  if (impl_->scene.ground.empty() || !(direction.z < 0.0)) return {};
  const double way = (impl_->scene.ground[0][0].z - origin.z) / direction.z, last = 0.5 * impl_->scene.ground_gap / direction.z;
  if (!(way >= 0.0 && way <= range)) return {};
  const CopyHit hit = first_hit(origin + (way + last) * direction, direction, 0.0);
  return hit.kind == CopyHit::Kind::ground ? hit : CopyHit{};
}

void CopyRays::set_hidden(const std::vector<std::uint32_t>& copies, bool hidden) {
  std::vector<bool> meant(impl_->scene.copies.size(), false);
  for (const auto c : copies) meant[c] = true;
  for (std::size_t i = 0; i < impl_->instance_copy.size(); ++i) {
    if (!meant[impl_->instance_copy[i]]) continue;
    const auto geometry = rtcGetGeometry(impl_->top.get(), static_cast<unsigned>(i));
    if (hidden)
      rtcDisableGeometry(geometry);
    else
      rtcEnableGeometry(geometry);
  }
  impl_->device.commit(impl_->top.get());
  impl_->device.check("copies");
}

bool CopyRays::occluded(const Vec3& origin, const Vec3& direction, double skip, double range) const {
  return impl_->trace(impl_->top.get(), origin, direction, skip, range).kind != CopyHit::Kind::nothing;
}

std::size_t CopyRays::bytes() const {
  return impl_->device.bytes() + impl_->instance_copy.capacity() * 4 + impl_->instance_moved.capacity() * sizeof(Vec3);
}

}  // namespace sunfleck
