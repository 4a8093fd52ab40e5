#include <sunfleck/visibility/quick_rays.hpp>

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

struct Query : RTCIntersectContext {
  std::uint32_t start;
};

void leave_start_out(const RTCFilterFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i)
    if (RTCHitN_primID(a->hit, a->N, i) == static_cast<const Query*>(a->context)->start) a->valid[i] = 0;
}

}  // namespace

struct QuickRays::Impl {
  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
  };
  const FacetScene& scene;
  Vec3 origin{0.0};
  double size = 1.0;
  std::unique_ptr<RTCDeviceTy, Release> device;
  std::unique_ptr<RTCSceneTy, Release> embree;
};

QuickRays::QuickRays(const FacetScene& scene) : impl_(std::make_unique<Impl>(Impl{.scene = scene, .device = nullptr, .embree = nullptr})) {
  auto& i = *impl_;
  if (scene.bounds.empty()) return;
  i.origin = scene.bounds.centre(), i.size = glm::length(scene.bounds.size());
  i.device.reset(rtcNewDevice(nullptr));
  if (!i.device) throw Error("Embree could not be started (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  i.embree.reset(rtcNewScene(i.device.get()));
  rtcSetSceneFlags(i.embree.get(), RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(i.embree.get(), RTC_BUILD_QUALITY_LOW);
  const std::size_t n = scene.size();
  RTCGeometry geometry = rtcNewGeometry(i.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
  auto* indices =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    throw Error("not enough memory for the geometry of " + std::to_string(n) + " facets");
  }
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = scene.corners[f][k] - i.origin;
      for (int c = 0; c < 3; ++c) vertices[9 * f + 3 * k + static_cast<std::size_t>(c)] = static_cast<float>(p[c]);
      // A facet without area names one corner three times and is met by no ray.
      indices[3 * f + k] = static_cast<unsigned>(3 * f + (scene.area[f] > 0.0f ? k : 0));
    }
  });
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(i.embree.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(i.embree.get());
  if (const auto error = rtcGetDeviceError(i.device.get()); error != RTC_ERROR_NONE)
    throw Error("Embree could not build its tree over " + std::to_string(n) + " facets (error " + std::to_string(error) + ")");
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
  Query query;
  rtcInitIntersectContext(&query);
  query.start = start;
  if (start != no_facet) query.filter = leave_start_out;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(q.x), ray.ray.org_y = static_cast<float>(q.y), ray.ray.org_z = static_cast<float>(q.z);
  ray.ray.dir_x = static_cast<float>(direction.x), ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tnear = 0.0f, ray.ray.tfar = static_cast<float>(std::min(range - begin, 1e30));
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->embree.get(), &query, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.facet = ray.hit.primID;
  hit.front = glm::dot(direction, area_vector(impl_->scene.corners[hit.facet])) < 0.0;
  hit.u = std::clamp(static_cast<double>(ray.hit.u), 0.0, 1.0), hit.v = std::clamp(static_cast<double>(ray.hit.v), 0.0, 1.0 - hit.u);
  hit.distance = begin + static_cast<double>(ray.ray.tfar);
  return hit;
}

}  // namespace sunfleck
