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
#include <sunfleck/core/memory.hpp>

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

/// A facet, seen from another of the same copy with which it is stacked.
struct Neighbour {
  std::uint32_t facet;
  Image image;    ///< relative to the other's
  double height;  ///< above the other's front: the same side in every copy
};
using Stacks = std::unordered_map<std::uint32_t, std::vector<Neighbour>>;

/// What the filter of a query needs to know.
struct Query : RTCIntersectContext {
  const void* scene;
  CopyFacet start;
  Image cell;
  const std::vector<Neighbour>* stack;  ///< of the start facet; null = none
};

struct ReleaseEmbree {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};

/// The geometry of one plant, about its middle and in units of its size.
struct PlantRays {
  const Plant* plant = nullptr;
  Box box;  ///< plant frame [m], of facets with area
  Vec3 middle{0.0};
  double scale = 1.0;                   ///< a power of two
  std::vector<std::uint32_t> facet_of;  ///< per primitive; empty = the same
  Stacks stacks;
  std::unique_ptr<RTCSceneTy, ReleaseEmbree> embree;
  std::uint32_t facet(unsigned primitive) const { return facet_of.empty() ? primitive : facet_of[primitive]; }
};

/// The power of two that makes an extent at most 1.
double scale_of(const Vec3& size) {
  return std::exp2(-std::ceil(std::log2(std::max({size.x, size.y, size.z, std::numeric_limits<double>::min()}))));
}

/// Calls visit(facet, corners in the plant's frame).
template <class Visit>
void each_facet(const Plant& plant, Visit&& visit) {
  std::uint32_t facet = 0;
  for (const auto& shape : plant.shapes)
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) visit(facet++, shape_triangle(plant, shape, t));
}

bool positive_area(const Triangle& t) {
  return static_cast<float>(glm::length(area_vector(t))) > 0.0f;
}

/// Keeps both facets of a pair; `height` is that of b above a along `up`. Counts pairs that are new.
void add_stacked(Stacks& stacks, std::uint32_t a, const Triangle& corners_a, std::uint32_t b, const Triangle& corners_b, Image b_from_a,
                 double height, std::size_t& entries) {
  const Vec3 up = upward_normal(corners_a);
  const auto add = [&](std::uint32_t to, const Triangle& corners, const Neighbour& n) {
    auto& list = stacks[to];
    for (const auto& known : list)
      if (known.facet == n.facet && known.image == n.image) return;
    list.push_back(n);
    if (glm::dot(area_vector(corners), up) < 0.0) list.back().height = -n.height;
    ++entries;
  };
  add(a, corners_a, {b, b_from_a, height});
  add(b, corners_b, {a, Image{} - b_from_a, -height});
}

/// Triangles of a new geometry of a scene; corners(i) tells where.
template <class Corners>
void attach_triangles(RTCDevice device, RTCScene scene, unsigned id, std::size_t n, Corners&& corners) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
  auto* indices =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    throw Error("not enough memory for the geometry of " + std::to_string(n) + " facets");
  }
  for (std::size_t p = 0; p < n; ++p) {
    const Triangle t = corners(p);
    for (std::size_t k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) vertices[9 * p + 3 * k + static_cast<std::size_t>(c)] = static_cast<float>(t[k][c]);
      indices[3 * p + k] = static_cast<unsigned>(3 * p + k);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

const auto scene_flags = static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);

/// How far apart two cells may be of which one piece is said to reach into both: more is a mistake of units.
void check_reach(const Box& b, double width, double depth) {
  if (!(std::max(std::abs(b.low.x), std::abs(b.high.x)) < 1e9 * width && std::max(std::abs(b.low.y), std::abs(b.high.y)) < 1e9 * depth))
    throw InputError("domain.periodic", "facets more than 10^9 cells away", "plants near a cell of about their size, all in metres");
}

/// The images whose box (local units) reaches into the cell: [low, high].
std::pair<Image, Image> images_in_cell(const Box& b, double width, double depth) {
  check_reach(b, width, depth);
  const auto first = [](double x, double period) { return static_cast<std::int32_t>(std::floor(x / period)); };
  const auto last = [](double x, double period) { return static_cast<std::int32_t>(std::ceil(x / period)) - 1; };
  const Image low{first(b.low.x, width), first(b.low.y, depth)};
  // What ends at a border does not reach into the next cell; one that lies in a border belongs to the cell it begins.
  return {low, {std::max(low.x, last(b.high.x, width)), std::max(low.y, last(b.high.y, depth))}};
}

}  // namespace

struct RayScene::Impl {
  Impl(const FacetScene* f, const FacetRows* r);

  Vec3 local(const Vec3& p) const { return (p - origin) * scale; }
  Triangle local_corners(CopyFacet facet, Image image) const;
  Triangle corners(CopyFacet f) const { return flat ? flat->corners[f.facet] : rows->corners(f); }
  /// Facets that are triangles of the scene itself: all, or those of the ground.
  CopyFacet own(std::uint32_t facet) const { return {own_copy, facet}; }
  bool has_area(std::uint32_t own_facet) const;

  void place();  ///< bounds, origin, scale, cell, range of heights
  void list_primitives();
  void list_instances();
  void find_stacks();
  void build();

  template <bool any>
  RayHit trace(Vec3 p, Vec3 d, CopyFacet start, double range) const;
  template <bool any>
  bool segment(const Vec3& from, const Vec3& d, double length, Query& query, RTCRayHit& found) const;
  const std::vector<Neighbour>* stack_of(CopyFacet facet) const;
  /// Among the facet and those stacked with it, the one that a ray meets first at a point of it; false if none holds the point.
  bool first_in_stack(CopyFacet facet, const Vec3& point, const Vec3& d, bool from_facet, Neighbour& first) const;

  static void filter(const RTCFilterFunctionNArguments* a);
  static bool monitor(void* self, ssize_t bytes, bool) {
    static_cast<Impl*>(self)->held += bytes;
    return true;
  }

  /// A copy, or an image of it that reaches into the cell.
  struct Instance {
    std::uint32_t copy;
    Image image;  ///< of the copy, that was moved into the cell
  };
  CopyFacet facet_at(unsigned instance, unsigned primitive) const {
    if (instance == RTC_INVALID_GEOMETRY_ID) return own(facet_of[primitive]);
    return {instances[instance].copy, plant_of(instances[instance].copy).facet(primitive)};
  }
  Image image_at(unsigned instance, unsigned primitive) const {
    if (!periodic) return {};
    return instance == RTC_INVALID_GEOMETRY_ID ? image_of[primitive] : instances[instance].image;
  }
  const PlantRays& plant_of(std::uint32_t copy) const { return plants[plant_rays[rows->placed().copies[copy].plant]]; }

  const FacetScene* flat;  ///< one of the two
  const FacetRows* rows;
  std::uint32_t own_copy;
  std::uint32_t own_count;
  Box bounds;
  std::optional<PeriodicCell> cell;
  Vec3 origin{0.0};
  double scale = 1.0;  // a power of two, so that the scale of a scene changes no rounding
  bool periodic = false;
  double width = 0, depth = 0;          // of the cell, in local units; the cell begins at local (0, 0)
  Box box;                              // of the geometry, in local units
  std::vector<std::uint32_t> facet_of;  // per own primitive
  std::vector<Image> image_of;          // per own primitive, periodic scenes only: the facet's image that was moved into the cell
  Stacks stacks;                        // of own facets
  std::size_t pairs = 0;
  std::atomic<std::int64_t> held{0};
  std::unique_ptr<RTCDeviceTy, ReleaseEmbree> device;  // after `held`, which it counts down when it goes
  std::vector<PlantRays> plants;
  std::vector<std::uint32_t> plant_rays;  // per row of Scene::plants: row of `plants`
  std::vector<Instance> instances;
  std::unique_ptr<RTCSceneTy, ReleaseEmbree> embree;
};

RayScene::Impl::Impl(const FacetScene* f, const FacetRows* r)
    : flat(f),
      rows(r),
      own_copy(f ? 0 : static_cast<std::uint32_t>(r->placed().copies.size())),
      own_count(static_cast<std::uint32_t>(f ? f->size() : r->placed().ground.size())),
      cell(f ? f->periodic : r->scene().periodic) {
  // One thread builds: the tree, and with it which of two facets a ray through their common edge meets, is then always the same.
  device.reset(rtcNewDevice("threads=1"));
  if (!device) throw Error("Embree could not be started (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceMemoryMonitorFunction(device.get(), monitor, this);
  if (rows) {
    std::unordered_map<const Plant*, std::uint32_t> known;
    plant_rays.resize(rows->scene().plants.size());
    for (const auto& copy : rows->placed().copies) {
      const Plant* plant = rows->scene().plants[copy.plant].plant.get();
      const auto [at, added] = known.try_emplace(plant, static_cast<std::uint32_t>(plants.size()));
      plant_rays[copy.plant] = at->second;
      if (!added) continue;
      auto& rays = plants.emplace_back();
      rays.plant = plant;
      each_facet(*plant, [&](std::uint32_t, const Triangle& t) {
        if (positive_area(t))
          for (const auto& p : t) rays.box.add(p);
      });
      if (rays.box.empty()) continue;
      rays.middle = rays.box.centre();
      rays.scale = scale_of(rays.box.size());
    }
  }
  place();
  list_primitives();
  list_instances();
  find_stacks();
  build();
}

bool RayScene::Impl::has_area(std::uint32_t own_facet) const {
  return flat ? flat->area[own_facet] > 0.0f : positive_area(rows->placed().ground[own_facet]);
}

/// The box about a mapped box.
static Box mapped(const Box& b, const Affine& map) {
  Box out;
  if (b.empty()) return out;
  for (int i = 0; i < 8; ++i) out.add(map.point({i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z}));
  return out;
}

void RayScene::Impl::place() {
  periodic = cell.has_value();
  if (flat) {
    bounds = flat->bounds;
  } else {
    for (std::uint32_t c = 0; c < own_copy; ++c) bounds.add(mapped(plant_of(c).box, rows->placed().copies[c].map));
    for (std::uint32_t f = 0; f < own_count; ++f)
      if (has_area(f))
        for (const auto& p : rows->placed().ground[f]) bounds.add(p);
  }
  if (bounds.empty()) return;
  Box extent = bounds;
  if (periodic) {
    extent.low.x = cell->x_low, extent.high.x = cell->x_high;
    extent.low.y = cell->y_low, extent.high.y = cell->y_high;
  }
  scale = scale_of(extent.size());
  origin = extent.centre();
  if (periodic) {
    origin.x = extent.low.x, origin.y = extent.low.y;
    width = cell->width() * scale, depth = cell->depth() * scale;
  }
  box = {local(bounds.low) - slack, local(bounds.high) + slack};
}

void RayScene::Impl::list_primitives() {
  const double most = std::min(1e7 + 32.0 * own_count, 4e9);  // a cell much smaller than the leaves is a mistake of units
  for (std::uint32_t f = 0; f < own_count; ++f) {
    if (!has_area(f)) continue;
    std::pair<Image, Image> images;
    if (periodic) {
      Box b;
      for (const auto& p : corners(own(f))) b.add(local(p));
      images = images_in_cell(b, width, depth);
    }
    const auto [low, high] = images;
    const double count = (1.0 + high.x - low.x) * (1.0 + high.y - low.y);
    if (static_cast<double>(facet_of.size()) + count > most)
      throw InputError("domain.periodic", "facets that reach over more than " + std::to_string(static_cast<std::uint64_t>(most)) + " cells",
                       "a cell of about the plants' size, all in metres");
    for (auto y = low.y; y <= high.y; ++y)
      for (auto x = low.x; x <= high.x; ++x) {
        facet_of.push_back(f);
        if (periodic) image_of.push_back({x, y});
      }
  }
}

void RayScene::Impl::list_instances() {
  const double most = 1e6 + 64.0 * own_copy;
  for (std::uint32_t c = 0; rows && c < own_copy; ++c) {
    if (plant_of(c).box.empty()) continue;
    std::pair<Image, Image> images;
    if (periodic) {
      const Box b = mapped(plant_of(c).box, rows->placed().copies[c].map);
      images = images_in_cell({local(b.low) - slack, local(b.high) + slack}, width, depth);
    }
    const auto [low, high] = images;
    if (static_cast<double>(instances.size()) + (1.0 + high.x - low.x) * (1.0 + high.y - low.y) > most)
      throw InputError("domain.periodic", "plants that reach over more than " + std::to_string(static_cast<std::uint64_t>(most)) + " cells",
                       "a cell of about the plants' size, all in metres");
    for (auto y = low.y; y <= high.y; ++y)
      for (auto x = low.x; x <= high.x; ++x) instances.push_back({c, {x, y}});
  }
}

Triangle RayScene::Impl::local_corners(CopyFacet facet, Image image) const {
  Triangle t = corners(facet);
  for (auto& p : t) p = local(p) + Vec3{image.x * width, image.y * depth, 0.0};
  return t;
}

void RayScene::Impl::find_stacks() {
  if (flat) {
    std::vector<StackCandidate> candidates(facet_of.size());
    const auto candidate = [&](std::uint32_t p) {
      const Image image = periodic ? image_of[p] : Image{};
      return local_corners(own(facet_of[p]), {-image.x, -image.y});
    };
    for (std::uint32_t p = 0; p < facet_of.size(); ++p) candidates[p] = {candidate(p), p, facet_of[p] >= flat->plant_facets};
    for (const auto& pair : find_stacked(candidates)) {
      const Image relative = periodic ? image_of[pair.first] - image_of[pair.second] : Image{};
      add_stacked(stacks, facet_of[pair.first], candidates[pair.first].corners, facet_of[pair.second], candidates[pair.second].corners,
                  relative, pair.height, pairs);
    }
    pairs /= 2;
    return;
  }
  // Tolerances are those of the scene: plants are seen at the size of their largest copy.
  std::vector<double> largest(plants.size(), 0.0);
  std::vector<std::size_t> copies(plants.size(), 0);
  for (const auto& copy : rows->placed().copies) {
    const auto p = plant_rays[copy.plant];
    ++copies[p];
    for (int i = 0; i < 3; ++i) largest[p] = std::max(largest[p], glm::length(copy.map.linear[i]));
  }
  for (std::size_t p = 0; p < plants.size(); ++p) {
    auto& plant = plants[p];
    std::vector<StackCandidate> candidates;
    each_facet(*plant.plant, [&](std::uint32_t f, Triangle t) {
      if (!positive_area(t)) return;
      for (auto& corner : t) corner = (corner - plant.middle) * (scale * largest[p]);
      candidates.push_back({t, f, false});
    });
    std::size_t entries = 0;
    for (const auto& pair : find_stacked(candidates)) {
      const auto &a = candidates[pair.first], &b = candidates[pair.second];
      add_stacked(plant.stacks, a.index, a.corners, b.index, b.corners, {}, pair.height, entries);
    }
    pairs += entries / 2 * copies[p];
  }
}

void RayScene::Impl::build() {
  for (auto& plant : plants) {
    std::size_t n = 0, all = 0;
    each_facet(*plant.plant, [&](std::uint32_t, const Triangle& t) { ++all, n += positive_area(t); });
    if (n == 0) continue;
    plant.embree.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(plant.embree.get(), scene_flags);
    std::size_t shape = 0;
    std::uint32_t triangle = 0, facet = 0;
    attach_triangles(device.get(), plant.embree.get(), 0, n, [&](std::size_t) {
      for (;;) {  // the next facet with area
        const auto& shapes = plant.plant->shapes;
        while (triangle == shapes[shape].triangle_count) ++shape, triangle = 0;
        Triangle t = shape_triangle(*plant.plant, shapes[shape], triangle++);
        const std::uint32_t f = facet++;
        if (!positive_area(t)) continue;
        if (n < all) plant.facet_of.push_back(f);
        for (auto& p : t) p = (p - plant.middle) * plant.scale;
        return t;
      }
    });
    rtcCommitScene(plant.embree.get());
  }
  embree.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(embree.get(), scene_flags);
  for (unsigned i = 0; i < instances.size(); ++i) {
    const auto& map = rows->placed().copies[instances[i].copy].map;
    const auto& plant = plant_of(instances[i].copy);
    // p' = scale (L (p / plant.scale + middle) + t - origin), moved by the image
    const Vec3 moved = local(map.point(plant.middle)) - Vec3{instances[i].image.x * width, instances[i].image.y * depth, 0.0};
    float matrix[12];
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) matrix[3 * column + row] = static_cast<float>(map.linear[column][row] * (scale / plant.scale));
    for (int row = 0; row < 3; ++row) matrix[9 + row] = static_cast<float>(moved[row]);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, plant.embree.get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree.get(), geometry, i);
    rtcReleaseGeometry(geometry);
  }
  if (!facet_of.empty())
    attach_triangles(device.get(), embree.get(), static_cast<unsigned>(instances.size()), facet_of.size(), [&](std::size_t p) {
      const Image image = periodic ? image_of[p] : Image{};
      return local_corners(own(facet_of[p]), {-image.x, -image.y});
    });
  rtcCommitScene(embree.get());
  if (const auto error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
    throw Error("Embree could not build its tree over " + std::to_string(facet_of.size()) + " facets and " +
                std::to_string(instances.size()) + " copies (error " + std::to_string(error) + ")");
}

/// Leaves out the start facet and what is stacked with it, in the image in which the ray starts.
void RayScene::Impl::filter(const RTCFilterFunctionNArguments* a) {
  const auto& query = *static_cast<const Query*>(a->context);
  const auto& self = *static_cast<const Impl*>(query.scene);
  const auto primitive = RTCHitN_primID(a->hit, a->N, 0), instance = RTCHitN_instID(a->hit, a->N, 0, 0);
  const CopyFacet facet = self.facet_at(instance, primitive);
  if (facet.copy != query.start.copy || (facet.facet != query.start.facet && !query.stack)) return;
  const Image image = self.periodic ? query.cell - self.image_at(instance, primitive) : Image{};
  if (facet.facet == query.start.facet && image == Image{}) a->valid[0] = 0;
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
RayHit RayScene::Impl::trace(Vec3 p, Vec3 d, CopyFacet start, double range) const {
  if (!(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < infinity) || !(std::abs(glm::dot(d, d) - 1.0) < 1e-3) || std::isnan(range))
    throw Error("a ray that is not finite, or whose direction is not a unit vector");
  RayHit hit;
  if (facet_of.empty() && instances.empty()) return hit;
  p = local(p);
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
        if (first.facet != facet.facet || first.image != Image{}) {
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
  std::size_t total = static_cast<std::size_t>(std::max<std::int64_t>(impl_->held, 0)) + bytes_of(impl_->facet_of) +
                      bytes_of(impl_->image_of) + bytes_of(impl_->instances);
  for (const auto& plant : impl_->plants) total += bytes_of(plant.facet_of);
  return total;
}

std::size_t RayScene::stacked_pairs() const {
  return impl_->pairs;
}

}  // namespace sunfleck
