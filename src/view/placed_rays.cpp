#include <sunfleck/view/placed_rays.hpp>

#include <algorithm>
#include <cmath>

#include <sunfleck/core/error.hpp>

#include "view/ray_tree.hpp"

namespace sunfleck {

using raytree::TreeNode;
using raytree::TreeQuery;

struct PlacedRays::Impl {
  Impl(const DrawnScene& s, std::size_t written_out) : scene(s), tree(s, written_out) {
    if (s.geometry().periodic) {
      cell = *s.geometry().periodic;
      const Box box = tree.box();
      const auto first = [](double x, double low, double size) { return static_cast<int>(std::floor((x - low) / size)); };
      low_x = first(box.low.x, cell.x_low, cell.width()), high_x = first(box.high.x, cell.x_low, cell.width());
      low_y = first(box.low.y, cell.y_low, cell.depth()), high_y = first(box.high.y, cell.y_low, cell.depth());
      Box levelled;
      for (int i = 0; i < 8; ++i)
        levelled.add(cell.levelled({i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z}));
      lowest = levelled.low.z, highest = levelled.high.z;
    }
  }

  PlacedHit repeated(const Vec3& origin, const Vec3& direction, double from, double to, std::size_t start, bool any) const;

  const DrawnScene& scene;
  raytree::Tree tree;
  PeriodicCell cell;
  int low_x = 0, high_x = 0, low_y = 0, high_y = 0;  ///< cells that the stored image reaches into
  double lowest = 0, highest = 0;                    ///< above the plane that it repeats along
};

/// Cell by cell along the ray, and in each cell the images that reach into it.
PlacedHit PlacedRays::Impl::repeated(const Vec3& origin, const Vec3& direction, double from, double to, std::size_t start, bool any) const {
  // The part of the ray within the heights of the geometry above the plane it repeats along.
  const double gain = cell.above(direction), height = cell.above(origin);
  if (gain != 0) {
    double enter = (lowest - height) / gain, leave = (highest - height) / gain;
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter), to = std::min(to, leave);
  } else if (height < lowest || height > highest) {
    return {};
  }
  const double slack = 1e-6 * std::max(cell.width(), cell.depth());
  from -= slack, to += slack;
  to = std::min(to, from + 4096.0 * std::max(cell.width(), cell.depth()));  // rays along the horizon end there
  if (!(from < to)) return {};
  const Vec3 p = origin + from * direction;
  int x = static_cast<int>(std::floor((p.x - cell.x_low) / cell.width())),
      y = static_cast<int>(std::floor((p.y - cell.y_low) / cell.depth()));
  const auto border = [](double o, double d, double low, double size, int i) {
    return d == 0 ? std::numeric_limits<double>::infinity() : (low + (i + (d > 0 ? 1 : 0)) * size - o) / d;
  };
  for (double at = from; at < to;) {
    const double next_x = border(origin.x, direction.x, cell.x_low, cell.width(), x),
                 next_y = border(origin.y, direction.y, cell.y_low, cell.depth(), y);
    const double next = std::min({next_x, next_y, to});
    PlacedHit best;
    double range = next + slack;
    for (int j = y - high_y; j <= y - low_y; ++j)
      for (int i = x - high_x; i <= x - low_x; ++i) {
        const Vec3 shift = cell.image(i, j);
        const auto hit = tree.trace(tree.world(), origin - shift, direction, std::max(0.0, at - slack), range,
                                    i == 0 && j == 0 ? start : no_placed_facet, any);
        if (hit && any) return hit;
        if (hit && hit.distance < best.distance) best = hit, range = hit.distance;
      }
    if (best) return best;
    if (next >= to) break;
    at = next;
    if (next_x <= next_y)
      x += direction.x > 0 ? 1 : -1;
    else
      y += direction.y > 0 ? 1 : -1;
  }
  return {};
}

PlacedRays::PlacedRays(const DrawnScene& scene, std::size_t written_out) : impl_(std::make_unique<Impl>(scene, written_out)) {}
PlacedRays::~PlacedRays() = default;

namespace {

void check_ray(const Vec3& o, const Vec3& d) {
  if (!(std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.z) && std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z)))
    throw Error("a ray whose origin or direction is not finite");
}

}  // namespace

PlacedHit PlacedRays::first_hit(const Vec3& origin, const Vec3& direction, Part part, double from, double to, std::size_t start) const {
  check_ray(origin, direction);
  if (part == Part::repeated && impl_->scene.geometry().periodic) return impl_->repeated(origin, direction, from, to, start, false);
  const auto* node = part == Part::ground ? impl_->tree.ground() : impl_->tree.world();
  return node ? impl_->tree.trace(node, origin, direction, from, to, start, false) : PlacedHit{};
}

bool PlacedRays::occluded(const Vec3& origin, const Vec3& direction, Part part, std::size_t start) const {
  check_ray(origin, direction);
  constexpr double far = std::numeric_limits<double>::infinity();
  if (part == Part::repeated && impl_->scene.geometry().periodic)
    return static_cast<bool>(impl_->repeated(origin, direction, 0, far, start, true));
  const auto* node = part == Part::ground ? impl_->tree.ground() : impl_->tree.world();
  return node && impl_->tree.trace(node, origin, direction, 0, far, start, true);
}

SurfacePoint PlacedRays::surface(const PlacedHit& hit, const Vec3& direction) const {
  SurfacePoint out;
  out.place = impl_->scene.place(hit.facet);
  out.corners = impl_->scene.corners(out.place);
  out.u = hit.u, out.v = hit.v;
  if (impl_->scene.swapped(out.place)) std::swap(out.u, out.v);
  const Vec3 n = area_vector(out.corners);
  const double length = glm::length(n);
  if (length > 0) out.normal = n / length;
  out.front = glm::dot(n, direction) < 0;
  return out;
}

std::size_t PlacedRays::bytes() const {
  return impl_->tree.bytes();
}

}  // namespace sunfleck
