// What natural pictures and maps share: rays, camera, and the loop over pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <sunfleck/view/picture.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// Unit normal of the front; zero where the area is zero.
Vec3 front_normal(const Triangle& corners);

/// Points that the default camera frames: corners of plant facets with area, or of the ground where there are no plants.
std::vector<Vec3> framed_points(const FacetScene& scene);

/// Rays for the camera and for shadows: the same but where one cell of a periodic scene is drawn, lit as part of all.
class PictureRays {
 public:
  PictureRays(const FacetScene& scene, bool infinite);
  const RayScene& camera() const { return cell_ ? *cell_ : all_; }
  const RayScene& shadow() const { return all_; }

 private:
  RayScene all_;
  std::unique_ptr<FacetScene> cell_scene_;
  std::unique_ptr<RayScene> cell_;
};

/// Mean of `samples` stratified rays for each pixel. `shade` gets a ray and a word of random bits of its own, and returns display light
/// in [0, 1], linear sRGB; it is called from many threads.
Image sample_picture(const Camera& camera, const PictureSettings& settings,
                     const std::function<Rgb(const CameraRay&, std::uint64_t)>& shade, Progress& progress);

}  // namespace sunfleck
