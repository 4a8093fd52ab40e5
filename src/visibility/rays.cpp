#include <sunfleck/visibility/rays.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/memory.hpp>

#include "visibility/ray_scene.hpp"
#include "visibility/stacked.hpp"

namespace sunfleck {

using namespace rayscene;

namespace {

constexpr double least_slope = 1e-6;           // of rays in periodic scenes
constexpr std::uint64_t most_cells = 1000000;  // that a ray is followed through: what has met nothing by then never will
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

/// Leaves out the start facet and what is stacked with it, in the image in which the ray starts.
void RayScene::Impl::filter(const RTCFilterFunctionNArguments* a) {
  const auto& query = *static_cast<const Query*>(a->context);
  const auto& self = *static_cast<const Impl*>(query.scene);
  const auto primitive = RTCHitN_primID(a->hit, a->N, 0), instance = RTCHitN_instID(a->hit, a->N, 0, 0);
  const CopyFacet facet = self.facet_at(instance, primitive);
  if (facet.copy != query.start.copy || (facet.facet != query.start.facet && !query.stack)) return;
  const CellImage image = self.periodic ? query.cell - self.image_at(instance, primitive) : CellImage{};
  if (facet.facet == query.start.facet && image == CellImage{}) a->valid[0] = 0;
  if (query.stack)
    for (const auto& n : *query.stack)
      if (facet.facet == n.facet && image == n.image) a->valid[0] = 0;
}

const std::vector<Neighbour>* RayScene::Impl::stack_of(CopyFacet facet) const {
  const Stacks& known = facet.copy == own_copy ? stacks : plant_of(facet.copy).stacks;
  if (known.empty()) return nullptr;
  const auto place = known.find(facet.facet);
  return place == known.end() ? nullptr : &place->second;
}

bool RayScene::Impl::first_in_stack(CopyFacet facet, const Vec3& point, const Vec3& d, bool from_facet, Neighbour& first) const {
  const Triangle shape = corners(facet);
  const Vec3 up = upward_normal(shape);
  const double towards = glm::dot(d, up) >= 0.0 ? 1.0 : -1.0;
  const double along_front = glm::dot(area_vector(shape), up) < 0.0 ? -towards : towards;
  const Neighbour self{facet.facet, {}, 0.0};
  // Order from low to high: by height, then row, then image.
  const auto before = [&](const Neighbour& a, const Neighbour& b) {
    if (std::abs(a.height - b.height) > 1e-12) return along_front * a.height < along_front * b.height;
    if (a.facet != b.facet) return (towards > 0.0) == (a.facet < b.facet);
    if (a.image.y != b.image.y) return (towards > 0.0) == (a.image.y < b.image.y);
    return (towards > 0.0) == (a.image.x < b.image.x);
  };
  bool found = !from_facet;
  first = self;
  for (const auto& n : *stack_of(facet)) {
    if (from_facet && !before(self, n)) continue;
    if (found && !before(n, first)) continue;
    double u, v;
    if (!barycentric(local_corners({facet.copy, n.facet}, n.image), point, u, v)) continue;
    first = n;
    found = true;
  }
  return found;
}

/// One piece of a ray in the cell's own coordinates.
template <bool any>
bool RayScene::Impl::segment(const Vec3& from, const Vec3& d, double length, Query& query, RTCRayHit& found) const {
  const RTCRay ray = embree_ray(from, d, 0.0, length);
  if constexpr (any)
    return embree_occluded(embree.get(), query, ray);
  else
    return embree_meets(embree.get(), query, ray, found);
}

template <bool any>
RayHit RayScene::Impl::trace(Vec3 p, Vec3 d, CopyFacet start, double range) const {
  if (!(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < infinity) || !(std::abs(glm::dot(d, d) - 1.0) < 1e-3) || std::isnan(range))
    throw Error("a ray that is not finite, or whose direction is not a unit vector");
  RayHit hit;
  if (facet_of.empty() && instances.empty()) return hit;
  p = local(p);
  Vec3 way = periodic ? cell->levelled(d) : d;  // among what is laid level; no unit vector on slopes
  range *= scale;
  const auto meet = [&](const RTCRayHit& at, double before) {
    hit.facet = 0;  // which one, occlusion does not tell
    if constexpr (!any) {
      const CopyFacet facet = facet_at(at.hit.instID[0], at.hit.primID);
      hit.copy = facet.copy, hit.facet = facet.facet;
      double u = at.hit.u, v = at.hit.v;
      if (facet.copy != own_copy && rows->placed().copies[facet.copy].map.mirrors()) std::swap(u, v);  // corners 1 and 2 are swapped
      const auto* stack = stack_of(facet);
      if (Neighbour first; stack) {
        const Triangle t = local_corners(facet, {});
        const Vec3 point = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        first_in_stack(facet, point, d, false, first);
        if (first.facet != facet.facet || first.image != CellImage{}) {
          barycentric(local_corners({facet.copy, first.facet}, first.image), point, u, v);
          hit.facet = first.facet;
        }
      }
      hit.front = glm::dot(d, area_vector(corners(hit.where()))) < 0.0;
      hit.u = u, hit.v = v, hit.distance = (before + at.ray.tfar) / scale;
    }
  };

  Query query;
  rtcInitIntersectContext(&query);
  query.scene = this;
  query.start = start;
  const bool on_facet = start.facet != no_facet;
  query.stack = on_facet ? stack_of(start) : nullptr;
  if (on_facet) query.filter = filter;
  if (Neighbour first; query.stack && first_in_stack(start, p, d, true, first)) {
    hit.copy = start.copy, hit.facet = first.facet;
    hit.front = glm::dot(d, area_vector(corners(hit.where()))) < 0.0;
    barycentric(local_corners(hit.where(), first.image), p, hit.u, hit.v);
    hit.distance = 0.0;
    return hit;
  }

  if (periodic && std::abs(way.z) < least_slope) way = glm::normalize(Vec3{way.x, way.y, way.z < 0.0 ? -least_slope : least_slope});
  // The part of the ray within the geometry's box (range of heights, if periodic), found in double precision: rays may come from afar.
  double begin = 0.0, end = range;
  for (int axis = periodic ? 2 : 0; axis < 3; ++axis) {
    if (way[axis] == 0.0) {
      if (p[axis] < box.low[axis] || p[axis] > box.high[axis]) return hit;
      continue;
    }
    const double a = (box.low[axis] - p[axis]) / way[axis], b = (box.high[axis] - p[axis]) / way[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin <= end)) return hit;

  RTCRayHit found;
  if (!periodic) {
    const double reach = end < range ? end - begin + slack : end - begin;
    if (segment<any>(p + begin * way, way, reach, query, found)) meet(found, begin);
    return hit;
  }

  // Cells in turn. Borders come from whole multiples of the period, so nothing drifts on long ways.
  const auto cell_at = [](double x, double period) { return std::floor(x / period); };
  const Vec3 entry = p + begin * way;
  double cx = cell_at(entry.x, width), cy = cell_at(entry.y, depth);
  std::uint64_t cells = 0;
  for (double t = begin; t <= end && cells < most_cells; ++cells) {
    const double out_x = way.x > 0.0 ? ((cx + 1.0) * width - p.x) / way.x : way.x < 0.0 ? (cx * width - p.x) / way.x : infinity;
    const double out_y = way.y > 0.0 ? ((cy + 1.0) * depth - p.y) / way.y : way.y < 0.0 ? (cy * depth - p.y) / way.y : infinity;
    const double out = std::min({out_x, out_y, end});
    const double back = t > 0.0 ? std::min(slack, t) : 0.0;  // but never behind the ray's own start
    query.cell = {static_cast<std::int32_t>(cx), static_cast<std::int32_t>(cy)};
    const double from = t - back, beyond = out < range ? slack : 0.0;
    const Vec3 q{p.x + from * way.x - cx * width, p.y + from * way.y - cy * depth, p.z + from * way.z};
    if (segment<any>(q, way, std::max(out - from + beyond, 0.0), query, found)) {
      meet(found, from);
      return hit;
    }
    if (out >= end) break;
    if (out_x <= out_y) cx += way.x > 0.0 ? 1.0 : -1.0;
    if (out_y <= out_x) cy += way.y > 0.0 ? 1.0 : -1.0;
    t = std::max(out, t);
  }
  return hit;
}

RayScene::RayScene(const FacetScene& scene) : impl_(std::make_unique<Impl>(&scene, nullptr)) {}
RayScene::RayScene(const FacetRows& rows) : impl_(std::make_unique<Impl>(nullptr, &rows)) {}
RayScene::~RayScene() = default;

RayHit RayScene::first_hit(const Vec3& origin, const Vec3& direction, CopyFacet start, double range) const {
  return impl_->trace<false>(origin, direction, start, range);
}

bool RayScene::occluded(const Vec3& origin, const Vec3& direction, CopyFacet start, double range) const {
  return static_cast<bool>(impl_->trace<true>(origin, direction, start, range));
}

CopyFacet RayScene::at(std::uint64_t row) const {
  return impl_->flat ? CopyFacet{0, static_cast<std::uint32_t>(row)} : impl_->rows->at(row);
}
std::uint64_t RayScene::facet_count() const {
  return impl_->flat ? impl_->flat->size() : impl_->rows->placed().facets;
}
std::uint64_t RayScene::plant_facets() const {
  return impl_->flat ? impl_->flat->plant_facets : impl_->rows->placed().first_ground_facet;
}
Triangle RayScene::corners(CopyFacet facet) const {
  return impl_->given_corners(facet);
}
Triangle RayScene::met_corners(CopyFacet facet) const {
  return impl_->corners(facet);
}
std::uint32_t RayScene::material(CopyFacet facet) const {
  return impl_->flat ? impl_->flat->optics[facet.facet] : impl_->rows->material(facet);
}
const std::vector<Optics>& RayScene::materials() const {
  return impl_->flat ? impl_->flat->materials : impl_->rows->materials();
}
const Box& RayScene::bounds() const {
  return impl_->bounds;
}
const std::optional<PeriodicCell>& RayScene::periodic() const {
  return impl_->cell;
}

std::size_t RayScene::bytes() const {
  std::size_t total = impl_->device.bytes() + bytes_of(impl_->facet_of) + bytes_of(impl_->image_of) + bytes_of(impl_->instances);
  for (const auto& plant : impl_->plants) total += bytes_of(plant.facet_of);
  return total;
}

std::size_t RayScene::stacked_pairs() const {
  return impl_->pairs;
}

}  // namespace sunfleck
