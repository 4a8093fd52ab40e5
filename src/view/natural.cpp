#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/picture.hpp>

#include "view/natural_light.hpp"
#include "view/picture_frame.hpp"

namespace sunfleck {

Image draw_natural(const FacetScene& scene, const FacetLight& light, const PictureSettings& settings, Progress& progress) {
  const PictureRays rays(scene, settings.infinite);
  NaturalLight natural(scene, light, rays.shadow());
  const auto points = framed_points(scene);
  const Camera camera(settings.camera, points, static_cast<double>(settings.width) / settings.height);

  const bool extended = !scene.periodic && scene.plant_facets < scene.size();
  double ground_height = std::numeric_limits<double>::infinity();
  for (std::size_t f = scene.plant_facets; f < scene.size(); ++f)
    for (const auto& p : scene.corners[f]) ground_height = std::min(ground_height, p.z);
  if (extended) natural.prepare_open_ground();
  const bool repeated = scene.periodic && settings.infinite;
  const double size = glm::length(scene.bounds.size()), haze_distance = 28.0 * size,
               clear_distance = glm::length(camera.eye() - scene.bounds.centre());
  const double far = repeated ? clear_distance + 4 * haze_distance : std::numeric_limits<double>::infinity();

  // Exposure from a coarse grid of the same rays.
  std::vector<float> luminances;
  constexpr int grid = 160;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) {
      const auto ray = camera.ray((x + 0.5) / grid, (y + 0.5) / grid);
      const auto hit = rays.camera().first_hit(ray.origin, ray.direction, no_facet, far);
      if (hit) luminances.push_back(luminance(natural.exitance(hit, mix(static_cast<std::uint64_t>(y * grid + x)))));
    }
  const Exposure exposure = exposure_for(std::move(luminances));

  const auto shade = [&](const CameraRay& ray, std::uint64_t bits) {
    const auto hit = rays.camera().first_hit(ray.origin, ray.direction, no_facet, far);
    const Rgb sky = sky_behind(ray.direction, natural.sunny());
    const auto haze = [&](const Rgb& near, double distance) {
      return glm::mix(near, sky, static_cast<float>(1 - std::exp(-std::max(0.0, distance - clear_distance) / haze_distance)));
    };
    if (hit) {
      const Rgb colour = tone_map(natural.exitance(hit, bits), exposure);
      return repeated ? haze(colour, hit.distance) : colour;
    }
    if (!extended || !(ray.direction.z < 0) || !(ray.origin.z > ground_height)) return sky;
    const double distance = (ground_height - ray.origin.z) / ray.direction.z;
    const Rgb ground = tone_map(natural.open_ground(ray.origin + distance * ray.direction, bits), exposure);
    return haze(ground, distance);
  };
  return sample_picture(camera, settings, shade, progress);
}

}  // namespace sunfleck
