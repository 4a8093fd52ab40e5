#include "visibility/embree_scene.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

EmbreeDevice::EmbreeDevice(Trees trees) : trees_(trees), device_(rtcNewDevice(nullptr)) {
  if (!device_) {
    const auto error = rtcGetDeviceError(nullptr);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory("Embree, which follows rays");
    throw Error(fmt::format("Embree could not be started (error {})", static_cast<int>(error)));
  }
  const auto count = [](void* held, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(held) += bytes;
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device_.get(), count, &held_);
}

EmbreeScenePointer EmbreeDevice::new_scene(RTCSceneFlags flags) const {
  EmbreeScenePointer scene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene.get(), flags);
  return scene;
}

void EmbreeDevice::commit(RTCScene scene) const {
  // Not by the device's option "threads=1": while such a device lives, all of the process has one thread (tbb::global_control).
  if (trees_ == Trees::quick)
    rtcCommitScene(scene);
  else
    tbb::task_arena(1).execute([scene] { rtcCommitScene(scene); });
}

void EmbreeDevice::check(const std::string& what) const {
  const auto error = rtcGetDeviceError(device_.get());
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory("the rays' tree over " + what);
  if (error != RTC_ERROR_NONE)
    throw Error(fmt::format("Embree could not build its tree over {} (error {})", what, static_cast<int>(error)));
}

std::size_t EmbreeDevice::bytes() const {
  return static_cast<std::size_t>(std::max<std::int64_t>(held_, 0));
}

EmbreeTriangles::EmbreeTriangles(const EmbreeDevice& device, std::size_t count)
    : geometry_(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE)),
      vertices_(static_cast<float*>(
          rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count))),
      indices_(static_cast<unsigned*>(
          rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count))) {
  if (!vertices_ || !indices_) throw OutOfMemory(fmt::format("the rays' geometry of {} facets", count));
}

void EmbreeTriangles::attach(RTCScene scene, unsigned id, RTCBuildQuality quality) {
  rtcSetGeometryBuildQuality(geometry_.get(), quality);
  rtcCommitGeometry(geometry_.get());
  rtcAttachGeometryByID(scene, geometry_.get(), id);
}

unsigned EmbreeMesh::vertex(const Vec3& p) {
  constexpr std::size_t looked_back = 32;  // leaves and internodes have fewer corners
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  const std::size_t n = vertices_.size() / 3, oldest = n > looked_back ? n - looked_back : 0;
  for (std::size_t i = n; i-- > oldest;)
    if (vertices_[3 * i] == x && vertices_[3 * i + 1] == y && vertices_[3 * i + 2] == z) return static_cast<unsigned>(i);
  vertices_.insert(vertices_.end(), {x, y, z});
  return static_cast<unsigned>(n);
}

void EmbreeMesh::add(const Triangle& corners, bool met) {
  const unsigned first = vertex(corners[0]);
  indices_.push_back(first);
  for (std::size_t k = 1; k < 3; ++k) indices_.push_back(met ? vertex(corners[k]) : first);  // one corner three times: no area
}

void EmbreeMesh::attach(const EmbreeDevice& device, RTCScene scene, unsigned id) {
  const std::unique_ptr<RTCGeometryTy, ReleaseEmbree> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices_.size() / 3);
  auto* indices =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), indices_.size() / 3);
  if (!vertices || !indices) throw OutOfMemory(fmt::format("the rays' geometry of {} facets", indices_.size() / 3));
  std::copy(vertices_.begin(), vertices_.end(), static_cast<float*>(vertices));
  std::copy(indices_.begin(), indices_.end(), static_cast<unsigned*>(indices));
  vertices_ = {};
  indices_ = {};
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

void attach_instance(const EmbreeDevice& device, RTCScene scene, unsigned id, RTCScene of, const Mat3& linear, const Vec3& move) {
  const std::unique_ptr<RTCGeometryTy, ReleaseEmbree> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), of);
  float columns[12];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) columns[3 * column + row] = static_cast<float>(linear[column][row]);
    columns[9 + row] = static_cast<float>(move[row]);
  }
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

RTCRay embree_ray(const Vec3& origin, const Vec3& direction, double from, double to) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x), ray.org_y = static_cast<float>(origin.y), ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x), ray.dir_y = static_cast<float>(direction.y), ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = static_cast<float>(from), ray.tfar = static_cast<float>(to), ray.mask = ~0u;
  return ray;
}

bool embree_meets(RTCScene scene, RTCIntersectContext& context, const RTCRay& ray, RTCRayHit& found) {
  found.ray = ray;
  found.hit.geomID = found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &found);
  return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool embree_occluded(RTCScene scene, RTCIntersectContext& context, RTCRay ray) {
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace sunfleck
