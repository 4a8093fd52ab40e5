// The inside of RayScene: geometry in trees, and what queries on it need. Built in ray_scene_build.cpp, asked in rays.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <sunfleck/visibility/ground_gap.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "visibility/embree_scene.hpp"

namespace sunfleck {

namespace rayscene {

inline constexpr double slack = 1e-6;  ///< how far parts of a ray overlap at borders, in units of the scene's size

/// Which image of a cell or facet: moved by (x width, y depth).
struct CellImage {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const CellImage&, const CellImage&) = default;
  friend CellImage operator-(const CellImage& a, const CellImage& b) { return {a.x - b.x, a.y - b.y}; }
};

/// A facet, seen from another of the same copy with which it is stacked.
struct Neighbour {
  std::uint32_t facet;
  CellImage image;  ///< relative to the other's
  double height;    ///< above the other's front: the same side in every copy
};
using Stacks = std::unordered_map<std::uint32_t, std::vector<Neighbour>>;

/// What the filter of a query needs to know.
struct Query : RTCIntersectContext {
  const void* scene;
  CopyFacet start;
  CellImage cell;
  const std::vector<Neighbour>* stack;  ///< of the start facet; null = none
};

/// The geometry of one plant, about its middle and in units of its size.
struct PlantRays {
  const Plant* plant = nullptr;
  Box box;  ///< plant frame [m], of facets with area
  Vec3 middle{0.0};
  double scale = 1.0;                   ///< a power of two
  std::vector<std::uint32_t> facet_of;  ///< per primitive; empty = the same
  Stacks stacks;
  EmbreeScenePointer embree;
  std::uint32_t facet(unsigned primitive) const { return facet_of.empty() ? primitive : facet_of[primitive]; }
};

}  // namespace rayscene

struct RayScene::Impl {
  using CellImage = rayscene::CellImage;
  using Neighbour = rayscene::Neighbour;
  using PlantRays = rayscene::PlantRays;
  using Query = rayscene::Query;
  using Stacks = rayscene::Stacks;

  Impl(const FacetScene* f, const FacetRows* r);

  /// About the origin, in units of the scene's size; on a slope with z above its plane, so that images of the cell are level.
  Vec3 local(const Vec3& p) const { return (cell ? cell->levelled(p - origin) : p - origin) * scale; }
  Triangle local_corners(CopyFacet facet, CellImage image) const;
  Triangle primitive_corners(std::size_t primitive) const;  ///< of an own primitive: where its image lies in the cell
  /// As rays meet it: the ground lies lower than it is given.
  Triangle corners(CopyFacet f) const {
    const bool ground = flat ? f.facet >= flat->plant_facets : f.copy == own_copy;
    return ground ? gap.lowered(given_corners(f)) : given_corners(f);
  }
  Triangle given_corners(CopyFacet f) const { return flat ? flat->corners[f.facet] : rows->corners(f); }
  /// Facets that are triangles of the scene itself: all, or those of the ground.
  CopyFacet own(std::uint32_t facet) const { return {own_copy, facet}; }
  bool has_area(std::uint32_t own_facet) const;

  void place();  ///< bounds, origin, scale, cell, range of heights
  void find_heights();
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

  /// A copy, or an image of it that reaches into the cell.
  struct Instance {
    std::uint32_t copy;
    CellImage image;  ///< of the copy, that was moved into the cell
  };
  CopyFacet facet_at(unsigned instance, unsigned primitive) const {
    if (instance == RTC_INVALID_GEOMETRY_ID) return own(facet_of[primitive]);
    return {instances[instance].copy, plant_of(instances[instance].copy).facet(primitive)};
  }
  CellImage image_at(unsigned instance, unsigned primitive) const {
    if (!periodic) return {};
    return instance == RTC_INVALID_GEOMETRY_ID ? image_of[primitive] : instances[instance].image;
  }
  const PlantRays& plant_of(std::uint32_t copy) const { return plants[plant_rays[rows->placed().copies[copy].plant]]; }

  const FacetScene* flat;  ///< one of the two
  const FacetRows* rows;
  std::uint32_t own_copy;
  std::uint32_t own_count;
  Box bounds;
  GroundGap gap;
  std::optional<PeriodicCell> cell;
  Vec3 origin{0.0};
  double scale = 1.0;  // a power of two, so that the scale of a scene changes no rounding
  bool periodic = false;
  double width = 0, depth = 0;          // of the cell, in local units; the cell begins at local (0, 0)
  Box box;                              // of the geometry, in local units
  std::vector<std::uint32_t> facet_of;  // per own primitive
  std::vector<CellImage> image_of;      // per own primitive, periodic scenes only: the facet's image that was moved into the cell
  Stacks stacks;                        // of own facets
  std::size_t pairs = 0;
  EmbreeDevice device{EmbreeDevice::Trees::same_for_any_threads};
  std::vector<PlantRays> plants;
  std::vector<std::uint32_t> plant_rays;  // per row of Scene::plants: row of `plants`
  std::vector<Instance> instances;
  EmbreeScenePointer embree;
};

}  // namespace sunfleck
