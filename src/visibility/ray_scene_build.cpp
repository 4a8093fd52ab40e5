#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <sunfleck/core/error.hpp>

#include "visibility/ray_scene.hpp"
#include "visibility/stacked.hpp"

namespace sunfleck {

using namespace rayscene;

namespace {

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
void add_stacked(Stacks& stacks, std::uint32_t a, const Triangle& corners_a, std::uint32_t b, const Triangle& corners_b, CellImage b_from_a,
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
  add(b, corners_b, {a, CellImage{} - b_from_a, -height});
}

/// How far apart two cells may be of which one piece is said to reach into both: more is a mistake of units.
void check_reach(const Box& b, double width, double depth) {
  if (!(std::max(std::abs(b.low.x), std::abs(b.high.x)) < 1e9 * width && std::max(std::abs(b.low.y), std::abs(b.high.y)) < 1e9 * depth))
    throw InputError("domain.periodic", "facets more than 10^9 cells away", "plants near a cell of about their size, all in metres");
}

/// Images that are told apart where a facet lies in one plane with images of its own: so many next to each other along x and along y.
constexpr std::int32_t most_stacked_images = 8;

/// Of the images that reach into the cell, those in which stacks are looked for: all, or as many in their middle.
std::pair<CellImage, CellImage> images_for_stacks(std::pair<CellImage, CellImage> images) {
  const auto shorten = [](std::int32_t& low, std::int32_t& high) {
    if (high - low < most_stacked_images) return;
    low += (high - low + 1 - most_stacked_images) / 2;
    high = low + most_stacked_images - 1;
  };
  shorten(images.first.x, images.second.x);
  shorten(images.first.y, images.second.y);
  return images;
}

/// The images whose box (local units) reaches into the cell: [low, high].
std::pair<CellImage, CellImage> images_in_cell(const Box& b, double width, double depth) {
  check_reach(b, width, depth);
  const auto first = [](double x, double period) { return static_cast<std::int32_t>(std::floor(x / period)); };
  const auto last = [](double x, double period) { return static_cast<std::int32_t>(std::ceil(x / period)) - 1; };
  const CellImage low{first(b.low.x, width), first(b.low.y, depth)};
  // What ends at a border does not reach into the next cell; one that lies in a border belongs to the cell it begins.
  return {low, {std::max(low.x, last(b.high.x, width)), std::max(low.y, last(b.high.y, depth))}};
}

/// The box about a mapped box.
Box mapped(const Box& b, const Affine& map) {
  Box out;
  if (b.empty()) return out;
  for (int i = 0; i < 8; ++i) out.add(map.point({i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z}));
  return out;
}

}  // namespace

RayScene::Impl::Impl(const FacetScene* f, const FacetRows* r)
    : flat(f),
      rows(r),
      own_copy(f ? 0 : static_cast<std::uint32_t>(r->placed().copies.size())),
      own_count(static_cast<std::uint32_t>(f ? f->size() : r->placed().ground.size())),
      cell(f ? f->periodic : r->scene().periodic) {
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

void RayScene::Impl::place() {
  periodic = cell.has_value();
  if (flat) {
    bounds = flat->bounds;
    gap = GroundGap(*flat);
  } else {
    for (std::uint32_t c = 0; c < own_copy; ++c) bounds.add(mapped(plant_of(c).box, rows->placed().copies[c].map));
    const Box plants_box = bounds;
    for (std::uint32_t f = 0; f < own_count; ++f)
      if (has_area(f))
        for (const auto& p : rows->placed().ground[f]) bounds.add(p);
    gap = GroundGap(plants_box, bounds);
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
  box = {local(bounds.low - Vec3{0.0, 0.0, gap.metres()}) - slack, local(bounds.high) + slack};
  if (periodic && !cell->is_level()) find_heights();
}

/// Above the plane of a slope, which goes through all heights itself.
void RayScene::Impl::find_heights() {
  Box b;
  for (std::uint32_t f = 0; f < own_count; ++f)
    if (has_area(f))
      for (const auto& p : corners(own(f))) b.add(local(p));
  for (std::uint32_t c = 0; rows && c < own_copy; ++c)
    if (const Box& of_plant = plant_of(c).box; !of_plant.empty())
      for (int i = 0; i < 8; ++i)
        b.add(local(rows->placed().copies[c].map.point({i & 1 ? of_plant.high.x : of_plant.low.x, i & 2 ? of_plant.high.y : of_plant.low.y,
                                                        i & 4 ? of_plant.high.z : of_plant.low.z})));
  box.low.z = b.low.z - slack, box.high.z = b.high.z + slack;
}

void RayScene::Impl::list_primitives() {
  const double most = std::min(2e6 + 32.0 * own_count, 4e9);  // a cell much smaller than the leaves is a mistake of units
  for (std::uint32_t f = 0; f < own_count; ++f) {
    if (!has_area(f)) continue;
    std::pair<CellImage, CellImage> images;
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
  const double most = 2e5 + 64.0 * own_copy;
  for (std::uint32_t c = 0; rows && c < own_copy; ++c) {
    if (plant_of(c).box.empty()) continue;
    std::pair<CellImage, CellImage> images;
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

Triangle RayScene::Impl::local_corners(CopyFacet facet, CellImage image) const {
  Triangle t = corners(facet);
  for (auto& p : t) p = local(p) + Vec3{image.x * width, image.y * depth, 0.0};
  return t;
}

Triangle RayScene::Impl::primitive_corners(std::size_t primitive) const {
  const CellImage image = periodic ? image_of[primitive] : CellImage{};
  return local_corners(own(facet_of[primitive]), {-image.x, -image.y});
}

void RayScene::Impl::find_stacks() {
  if (flat) {
    std::vector<StackCandidate> candidates;
    std::vector<std::uint32_t> primitive_of;
    for (std::uint32_t begin = 0, end = 0; begin < facet_of.size(); begin = end) {
      while (end < facet_of.size() && facet_of[end] == facet_of[begin]) ++end;
      const auto [low, high] = periodic ? images_for_stacks({image_of[begin], image_of[end - 1]}) : std::pair<CellImage, CellImage>{};
      for (std::uint32_t p = begin; p < end; ++p) {
        const CellImage image = periodic ? image_of[p] : CellImage{};
        if (image.x < low.x || image.x > high.x || image.y < low.y || image.y > high.y) continue;
        candidates.push_back({primitive_corners(p), p, facet_of[p] >= flat->plant_facets});
        primitive_of.push_back(p);
      }
    }
    for (const auto& pair : find_stacked(candidates)) {
      const auto first = primitive_of[pair.first], second = primitive_of[pair.second];
      const CellImage relative = periodic ? image_of[first] - image_of[second] : CellImage{};
      add_stacked(stacks, facet_of[first], candidates[pair.first].corners, facet_of[second], candidates[pair.second].corners, relative,
                  pair.height, pairs);
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
  const RTCSceneFlags flags = RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
  for (auto& plant : plants) {
    std::size_t n = 0, all = 0;
    each_facet(*plant.plant, [&](std::uint32_t, const Triangle& t) { ++all, n += positive_area(t); });
    if (n == 0) continue;
    plant.embree = device.new_scene(flags);
    EmbreeTriangles triangles(device, n);
    std::size_t next = 0;
    each_facet(*plant.plant, [&](std::uint32_t facet, Triangle t) {
      if (!positive_area(t)) return;
      for (auto& p : t) p = (p - plant.middle) * plant.scale;
      triangles.set(next++, t);
      if (n < all) plant.facet_of.push_back(facet);
    });
    triangles.attach(plant.embree.get(), 0);
    device.commit(plant.embree.get());
  }
  embree = device.new_scene(flags);
  Mat3 levelling(1.0);
  if (cell)
    for (int axis = 0; axis < 3; ++axis) levelling[axis] = cell->levelled(Mat3(1.0)[axis]);
  for (unsigned i = 0; i < instances.size(); ++i) {
    const auto& map = rows->placed().copies[instances[i].copy].map;
    const auto& plant = plant_of(instances[i].copy);
    // p' = scale (L (p / plant.scale + middle) + t - origin), moved by the image
    const Vec3 move = local(map.point(plant.middle)) - Vec3{instances[i].image.x * width, instances[i].image.y * depth, 0.0};
    attach_instance(device, embree.get(), i, plant.embree.get(), levelling * map.linear * (scale / plant.scale), move);
  }
  if (!facet_of.empty()) {
    EmbreeTriangles triangles(device, facet_of.size());
    for (std::size_t p = 0; p < facet_of.size(); ++p) triangles.set(p, primitive_corners(p));
    triangles.attach(embree.get(), static_cast<unsigned>(instances.size()));
  }
  device.commit(embree.get());
  device.check(std::to_string(facet_of.size()) + " facets and " + std::to_string(instances.size()) + " copies");
}

}  // namespace sunfleck
