// What every use of Embree needs: a device that counts its bytes, triangles, copies, rays.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

struct ReleaseEmbree {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
  void operator()(RTCGeometry g) const { rtcReleaseGeometry(g); }
};
using EmbreeScenePointer = std::unique_ptr<RTCSceneTy, ReleaseEmbree>;

/// A device and the bytes that it holds. It must outlive its scenes.
class EmbreeDevice {
 public:
  enum class Trees {
    same_for_any_threads,  ///< one thread builds them: the tree, and with it which of two facets a ray through their common edge meets, and
                           ///< whether a ray that grazes a box meets what is in it, is then always the same
    quick                  ///< all cores build them
  };

  /// Throws Error if Embree cannot be started.
  explicit EmbreeDevice(Trees trees);
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_.get(); }
  EmbreeScenePointer new_scene(RTCSceneFlags flags) const;
  /// Builds the scene's tree, on as many threads as `trees` allows.
  void commit(RTCScene scene) const;
  /// Throws Error if any call since the last check has failed; `what` is what trees were built over: "12 facets".
  void check(const std::string& what) const;
  /// Held by trees and the geometry in them, counted as they were allocated.
  std::size_t bytes() const;

 private:
  std::atomic<std::int64_t> held_{0};
  Trees trees_;
  std::unique_ptr<RTCDeviceTy, ReleaseEmbree> device_;  // after held_, which it counts down when it goes
};

/// Triangles on their way into a scene, each with corners of its own.
class EmbreeTriangles {
 public:
  /// Throws Error if memory does not suffice.
  EmbreeTriangles(const EmbreeDevice& device, std::size_t count);

  /// From any number of threads. What is not `met` has a place, but no ray meets it.
  void set(std::size_t triangle, const Triangle& corners, bool met = true) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        vertices_[9 * triangle + 3 * k + static_cast<std::size_t>(axis)] = static_cast<float>(corners[k][axis]);
      indices_[3 * triangle + k] = static_cast<unsigned>(3 * triangle + (met ? k : 0));  // one corner three times: no area
    }
  }
  void attach(RTCScene scene, unsigned id, RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);

 private:
  std::unique_ptr<RTCGeometryTy, ReleaseEmbree> geometry_;
  float* vertices_;
  unsigned* indices_;
};

/// The same for triangles that share corners with those shortly before them, as those of one mesh do: a third of the memory.
class EmbreeMesh {
 public:
  void add(const Triangle& corners, bool met = true);
  /// Hands everything over. Throws Error if memory does not suffice.
  void attach(const EmbreeDevice& device, RTCScene scene, unsigned id);

 private:
  unsigned vertex(const Vec3& p);

  std::vector<float> vertices_;
  std::vector<unsigned> indices_;
};

/// A copy of a committed scene in another: p -> linear p + move.
void attach_instance(const EmbreeDevice& device, RTCScene scene, unsigned id, RTCScene of, const Mat3& linear, const Vec3& move);

RTCRay embree_ray(const Vec3& origin, const Vec3& direction, double from, double to);

/// The first thing that a ray meets; false if there is none.
bool embree_meets(RTCScene scene, RTCIntersectContext& context, const RTCRay& ray, RTCRayHit& found);
/// Does it meet anything?
bool embree_occluded(RTCScene scene, RTCIntersectContext& context, RTCRay ray);

}  // namespace sunfleck
