#include <sunfleck/visibility/quick_rays.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <sunfleck/core/error.hpp>

#include "visibility/embree_scene.hpp"

namespace sunfleck {

namespace {

struct StartSkip : RTCIntersectContext {
  std::uint32_t start;
};

void leave_start_out(const RTCFilterFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i)
    if (RTCHitN_primID(a->hit, a->N, i) == static_cast<const StartSkip*>(a->context)->start) a->valid[i] = 0;
}

}  // namespace

struct QuickRays::Impl {
  explicit Impl(const FacetScene& s) : scene(s) {}

  const FacetScene& scene;
  Vec3 origin{0.0};
  double size = 1.0;
  EmbreeDevice device{EmbreeDevice::Trees::quick};
  EmbreeScenePointer embree;
};

QuickRays::QuickRays(const FacetScene& scene) : impl_(std::make_unique<Impl>(scene)) {
  auto& i = *impl_;
  if (scene.bounds.empty()) return;
  i.origin = scene.bounds.centre(), i.size = glm::length(scene.bounds.size());
  i.embree = i.device.new_scene(RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(i.embree.get(), RTC_BUILD_QUALITY_LOW);
  EmbreeTriangles triangles(i.device, scene.size());
  tbb::parallel_for(std::size_t{0}, scene.size(), [&](std::size_t f) {
    const Triangle& t = scene.corners[f];
    triangles.set(f, {t[0] - i.origin, t[1] - i.origin, t[2] - i.origin}, scene.area[f] > 0.0f);
  });
  triangles.attach(i.embree.get(), 0, RTC_BUILD_QUALITY_LOW);
  i.device.commit(i.embree.get());
  i.device.check(std::to_string(scene.size()) + " facets");
}

QuickRays::~QuickRays() = default;

RayHit QuickRays::first_hit(const Vec3& origin, const Vec3& direction, std::uint32_t start, double range) const {
  RayHit hit;
  if (!impl_->embree) return hit;
  const auto finite = [](const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  if (!finite(origin) || !finite(direction)) throw Error("QuickRays: a ray that is not finite");
  // Rays may come from afar: they start where they enter a ball about the scene, found in double precision.
  const Vec3 p = origin - impl_->origin;
  const double begin = std::max(0.0, -glm::dot(p, direction) - impl_->size);
  if (begin > range) return hit;
  const Vec3 q = p + begin * direction;
  StartSkip query;
  rtcInitIntersectContext(&query);
  query.start = start;
  if (start != no_facet) query.filter = leave_start_out;
  RTCRayHit ray;
  if (!embree_meets(impl_->embree.get(), query, embree_ray(q, direction, 0.0, std::min(range - begin, 1e30)), ray)) return hit;
  hit.facet = ray.hit.primID;
  hit.front = glm::dot(direction, area_vector(impl_->scene.corners[hit.facet])) < 0.0;
  hit.u = std::clamp(static_cast<double>(ray.hit.u), 0.0, 1.0), hit.v = std::clamp(static_cast<double>(ray.hit.v), 0.0, 1.0 - hit.u);
  hit.distance = begin + static_cast<double>(ray.ray.tfar);
  return hit;
}

}  // namespace sunfleck
