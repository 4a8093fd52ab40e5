#include <sunfleck/visibility/rays.hpp>

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include <sunfleck/core/error.hpp>

#include "stacked.hpp"

namespace sunfleck {

namespace {

constexpr double slack = 1e-6;        // how far parts of a ray overlap at borders, in units of the scene's size
constexpr double least_slope = 1e-6;  // of rays in periodic scenes
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Which image of a cell or facet: moved by (x width, y depth).
struct Image {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const Image&, const Image&) = default;
  friend Image operator-(const Image& a, const Image& b) { return {a.x - b.x, a.y - b.y}; }
};

/// A facet, seen from another with which it is stacked.
struct Neighbour {
  std::uint32_t facet;
  Image image;    ///< relative to the other's
  double height;  ///< above the other, along the common upward normal
};

/// What the filter of a query needs to know.
struct Query : RTCIntersectContext {
  const void* scene;
  std::uint32_t start;
  Image cell;
  const std::vector<Neighbour>* stack;  ///< of the start facet; null = none
};

}  // namespace

struct RayScene::Impl {
  explicit Impl(const FacetScene& s);

  void place();  ///< origin, scale, cell, range of heights
  void list_primitives();
  void find_stacks();
  void build();
  Vec3 local(const Vec3& p) const { return (p - origin) * scale; }
  Triangle local_corners(std::uint32_t facet, Image image) const;

  template <bool any>
  RayHit trace(Vec3 p, Vec3 d, std::uint32_t start, double range) const;
  template <bool any>
  bool segment(const Vec3& from, const Vec3& d, double length, Query& query, RTCRayHit& found) const;
  const std::vector<Neighbour>* stack_of(std::uint32_t facet) const;
  /// Among the facet and those stacked with it, the one that a ray meets first at a point of it; false if none holds the point.
  bool first_in_stack(std::uint32_t facet, const Vec3& point, const Vec3& d, bool from_facet, Neighbour& first) const;

  static void filter(const RTCFilterFunctionNArguments* a);
  static bool monitor(void* self, ssize_t bytes, bool) {
    static_cast<Impl*>(self)->held += bytes;
    return true;
  }

  const FacetScene& scene;
  Vec3 origin{0.0};
  double scale = 1.0;  // a power of two, so that the scale of a scene changes no rounding
  bool periodic = false;
  double width = 0, depth = 0;          // of the cell, in local units; the cell begins at local (0, 0)
  Box box;                              // of the geometry, in local units
  std::vector<std::uint32_t> facet_of;  // per primitive; empty if primitive = facet row
  std::vector<Image> image_of;          // per primitive, periodic scenes only: the facet's image that was moved into the cell
  std::unordered_map<std::uint32_t, std::vector<Neighbour>> stacks;
  std::size_t pairs = 0;
  std::atomic<std::int64_t> held{0};
  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device;  // after `held`, which it counts down when it goes
  std::unique_ptr<RTCSceneTy, Release> embree;
};

RayScene::Impl::Impl(const FacetScene& s) : scene(s) {
  place();
  list_primitives();
  find_stacks();
  build();
}

void RayScene::Impl::place() {
  periodic = scene.periodic.has_value();
  if (scene.bounds.empty()) return;
  Box extent = scene.bounds;
  if (periodic) {
    extent.low.x = scene.periodic->x_low, extent.high.x = scene.periodic->x_high;
    extent.low.y = scene.periodic->y_low, extent.high.y = scene.periodic->y_high;
  }
  const Vec3 size = extent.size();
  scale = std::exp2(-std::ceil(std::log2(std::max({size.x, size.y, size.z, std::numeric_limits<double>::min()}))));
  origin = extent.centre();
  if (periodic) {
    origin.x = extent.low.x, origin.y = extent.low.y;
    width = scene.periodic->width() * scale, depth = scene.periodic->depth() * scale;
  }
  box = {local(scene.bounds.low) - slack, local(scene.bounds.high) + slack};
}

void RayScene::Impl::list_primitives() {
  const auto n = static_cast<std::uint32_t>(scene.size());
  const double most = std::min(1e7 + 32.0 * n, 4e9);  // a cell much smaller than the leaves is a mistake of units
  for (std::uint32_t f = 0; f < n; ++f) {
    if (!(scene.area[f] > 0.0f)) continue;
    Image low, high;
    if (periodic) {
      Box b;
      for (const auto& p : scene.corners[f]) b.add(local(p));
      if (!(std::max(std::abs(b.low.x), std::abs(b.high.x)) < 1e9 * width && std::max(std::abs(b.low.y), std::abs(b.high.y)) < 1e9 * depth))
        throw InputError("domain.periodic", "facets more than 10^9 cells away", "plants near a cell of about their size, all in metres");
      const auto first = [](double x, double period) { return static_cast<std::int32_t>(std::floor(x / period)); };
      const auto last = [](double x, double period) { return static_cast<std::int32_t>(std::ceil(x / period)) - 1; };
      low = {first(b.low.x, width), first(b.low.y, depth)};
      // A facet that ends at a border does not reach into the next cell; one that lies in a border belongs to the cell it begins.
      high = {std::max(low.x, last(b.high.x, width)), std::max(low.y, last(b.high.y, depth))};
    }
    const double images = (1.0 + high.x - low.x) * (1.0 + high.y - low.y);
    if (static_cast<double>(facet_of.size()) + images > most)
      throw InputError("domain.periodic", "facets that reach over more than " + std::to_string(static_cast<std::uint64_t>(most)) + " cells",
                       "a cell of about the plants' size, all in metres");
    for (auto y = low.y; y <= high.y; ++y)
      for (auto x = low.x; x <= high.x; ++x) {
        facet_of.push_back(f);
        if (periodic) image_of.push_back({x, y});
      }
  }
}

Triangle RayScene::Impl::local_corners(std::uint32_t facet, Image image) const {
  Triangle t = scene.corners[facet];
  for (auto& p : t) p = local(p) + Vec3{image.x * width, image.y * depth, 0.0};
  return t;
}

void RayScene::Impl::find_stacks() {
  std::vector<StackCandidate> candidates(facet_of.size());
  for (std::uint32_t p = 0; p < facet_of.size(); ++p) {
    const Image image = periodic ? image_of[p] : Image{};
    candidates[p] = {local_corners(facet_of[p], {-image.x, -image.y}), p, facet_of[p] >= scene.plant_facets};
  }
  const auto add = [&](std::uint32_t to, const Neighbour& n) {
    auto& list = stacks[to];
    for (const auto& known : list)
      if (known.facet == n.facet && known.image == n.image) return;
    list.push_back(n);
    ++pairs;
  };
  for (const auto& pair : find_stacked(candidates)) {
    const auto a = facet_of[pair.first], b = facet_of[pair.second];
    const Image relative = periodic ? image_of[pair.first] - image_of[pair.second] : Image{};
    add(a, {b, relative, pair.height});
    add(b, {a, Image{} - relative, -pair.height});
  }
  pairs /= 2;
}

void RayScene::Impl::build() {
  // One thread builds: the tree, and with it which of two facets a ray through their common edge meets, is then always the same.
  device.reset(rtcNewDevice("threads=1"));
  if (!device) throw Error("Embree could not be started (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceMemoryMonitorFunction(device.get(), monitor, this);
  embree.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(embree.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  const std::size_t n = facet_of.size();
  if (n > 0) {
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
    auto* indices =
        static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
    if (!vertices || !indices) {
      rtcReleaseGeometry(geometry);
      throw Error("not enough memory for the geometry of " + std::to_string(n) + " facets");
    }
    for (std::size_t p = 0; p < n; ++p) {
      const Image image = periodic ? image_of[p] : Image{};
      const Triangle t = local_corners(facet_of[p], {-image.x, -image.y});
      for (std::size_t k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c) vertices[9 * p + 3 * k + static_cast<std::size_t>(c)] = static_cast<float>(t[k][c]);
        indices[3 * p + k] = static_cast<unsigned>(3 * p + k);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(embree.get());
  if (const auto error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
    throw Error("Embree could not build its tree over " + std::to_string(n) + " facets (error " + std::to_string(error) + ")");
}

/// Leaves out the start facet and what is stacked with it, in the image in which the ray starts.
void RayScene::Impl::filter(const RTCFilterFunctionNArguments* a) {
  const auto& query = *static_cast<const Query*>(a->context);
  const auto& self = *static_cast<const Impl*>(query.scene);
  const auto primitive = RTCHitN_primID(a->hit, a->N, 0);
  const auto facet = self.facet_of[primitive];
  if (facet != query.start && !query.stack) return;
  const Image image = self.periodic ? query.cell - self.image_of[primitive] : Image{};
  if (facet == query.start && image == Image{}) a->valid[0] = 0;
  if (query.stack)
    for (const auto& n : *query.stack)
      if (facet == n.facet && image == n.image) a->valid[0] = 0;
}

const std::vector<Neighbour>* RayScene::Impl::stack_of(std::uint32_t facet) const {
  if (stacks.empty()) return nullptr;
  const auto place = stacks.find(facet);
  return place == stacks.end() ? nullptr : &place->second;
}

bool RayScene::Impl::first_in_stack(std::uint32_t facet, const Vec3& point, const Vec3& d, bool from_facet, Neighbour& first) const {
  const double towards = glm::dot(d, upward_normal(scene.corners[facet])) >= 0.0 ? 1.0 : -1.0;
  const Neighbour self{facet, {}, 0.0};
  // Order from low to high: by height, then row, then image.
  const auto before = [&](const Neighbour& a, const Neighbour& b) {
    if (a.height != b.height) return towards * a.height < towards * b.height;
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
    if (!barycentric(local_corners(n.facet, n.image), point, u, v)) continue;
    first = n;
    found = true;
  }
  return found;
}

/// One piece of a ray in the cell's own coordinates.
template <bool any>
bool RayScene::Impl::segment(const Vec3& from, const Vec3& d, double length, Query& query, RTCRayHit& found) const {
  RTCRay& ray = found.ray;
  ray.org_x = static_cast<float>(from.x), ray.org_y = static_cast<float>(from.y), ray.org_z = static_cast<float>(from.z);
  ray.dir_x = static_cast<float>(d.x), ray.dir_y = static_cast<float>(d.y), ray.dir_z = static_cast<float>(d.z);
  ray.tnear = 0.0f, ray.tfar = static_cast<float>(length), ray.time = 0.0f, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
  if constexpr (any) {
    rtcOccluded1(embree.get(), &query, &ray);
    return ray.tfar < 0.0f;
  } else {
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree.get(), &query, &found);
    return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
}

template <bool any>
RayHit RayScene::Impl::trace(Vec3 p, Vec3 d, std::uint32_t start, double range) const {
  if (!(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < infinity) || !(std::abs(glm::dot(d, d) - 1.0) < 1e-3) || std::isnan(range))
    throw Error("a ray that is not finite, or whose direction is not a unit vector");
  RayHit hit;
  if (facet_of.empty()) return hit;
  p = local(p);
  range *= scale;
  const auto meet = [&](const RTCRayHit& at, double before) {
    hit.facet = 0;  // which one, occlusion does not tell
    if constexpr (!any) {
      const std::uint32_t facet = hit.facet = facet_of[at.hit.primID];
      double u = at.hit.u, v = at.hit.v;
      const auto* stack = stack_of(facet);
      if (Neighbour first; stack) {
        const Triangle t = local_corners(facet, {});
        const Vec3 point = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        first_in_stack(facet, point, d, false, first);
        if (first.facet != facet || first.image != Image{}) {
          barycentric(local_corners(first.facet, first.image), point, u, v);
          hit.facet = first.facet;
        }
      }
      hit.front = glm::dot(d, area_vector(scene.corners[hit.facet])) < 0.0;
      hit.u = u, hit.v = v, hit.distance = (before + at.ray.tfar) / scale;
    }
  };

  Query query;
  rtcInitIntersectContext(&query);
  query.scene = this;
  query.start = start;
  query.stack = start == no_facet ? nullptr : stack_of(start);
  if (start != no_facet) query.filter = filter;
  if (Neighbour first; query.stack && first_in_stack(start, p, d, true, first)) {
    hit.facet = first.facet;
    hit.front = glm::dot(d, area_vector(scene.corners[first.facet])) < 0.0;
    barycentric(local_corners(first.facet, first.image), p, hit.u, hit.v);
    hit.distance = 0.0;
    return hit;
  }

  if (periodic && std::abs(d.z) < least_slope) d = glm::normalize(Vec3{d.x, d.y, d.z < 0.0 ? -least_slope : least_slope});
  // The part of the ray within the geometry's box (range of heights, if periodic), found in double precision: rays may come from afar.
  double begin = 0.0, end = range;
  for (int axis = periodic ? 2 : 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (p[axis] < box.low[axis] || p[axis] > box.high[axis]) return hit;
      continue;
    }
    const double a = (box.low[axis] - p[axis]) / d[axis], b = (box.high[axis] - p[axis]) / d[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin <= end)) return hit;

  RTCRayHit found;
  if (!periodic) {
    const double reach = end < range ? end - begin + slack : end - begin;
    if (segment<any>(p + begin * d, d, reach, query, found)) meet(found, begin);
    return hit;
  }

  // Cells in turn. Borders come from whole multiples of the period, so nothing drifts on long ways.
  const auto cell_at = [](double x, double period) { return std::floor(x / period); };
  const Vec3 entry = p + begin * d;
  double cx = cell_at(entry.x, width), cy = cell_at(entry.y, depth);
  for (double t = begin; t <= end;) {
    const double out_x = d.x > 0.0 ? ((cx + 1.0) * width - p.x) / d.x : d.x < 0.0 ? (cx * width - p.x) / d.x : infinity;
    const double out_y = d.y > 0.0 ? ((cy + 1.0) * depth - p.y) / d.y : d.y < 0.0 ? (cy * depth - p.y) / d.y : infinity;
    const double out = std::min({out_x, out_y, end});
    const double back = t > 0.0 ? std::min(slack, t) : 0.0;  // but never behind the ray's own start
    query.cell = {static_cast<std::int32_t>(cx), static_cast<std::int32_t>(cy)};
    const double from = t - back, beyond = out < range ? slack : 0.0;
    const Vec3 q{p.x + from * d.x - cx * width, p.y + from * d.y - cy * depth, p.z + from * d.z};
    if (segment<any>(q, d, std::max(out - from + beyond, 0.0), query, found)) {
      meet(found, from);
      return hit;
    }
    if (out >= end) break;
    if (out_x <= out_y) cx += d.x > 0.0 ? 1.0 : -1.0;
    if (out_y <= out_x) cy += d.y > 0.0 ? 1.0 : -1.0;
    t = std::max(out, t);
  }
  return hit;
}

RayScene::RayScene(const FacetScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
RayScene::~RayScene() = default;

RayHit RayScene::first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const {
  return impl_->trace<false>(origin, direction, start, range);
}

bool RayScene::occluded(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const {
  return static_cast<bool>(impl_->trace<true>(origin, direction, start, range));
}

std::size_t RayScene::bytes() const {
  return static_cast<std::size_t>(std::max<std::int64_t>(impl_->held, 0)) + impl_->facet_of.capacity() * sizeof(std::uint32_t) +
         impl_->image_of.capacity() * sizeof(Image);
}

std::size_t RayScene::stacked_pairs() const {
  return impl_->pairs;
}

}  // namespace sunfleck
