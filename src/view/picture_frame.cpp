#include "view/picture_frame.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

Vec3 front_normal(const Triangle& corners) {
  const Vec3 n = area_vector(corners);
  const double length = glm::length(n);
  return length > 0 ? n / length : Vec3{0.0};
}

std::vector<Vec3> framed_points(const FacetScene& scene) {
  const std::size_t end = scene.plant_facets > 0 ? scene.plant_facets : scene.size();
  std::vector<Vec3> points;
  points.reserve(3 * end);
  for (std::size_t f = 0; f < end; ++f)
    if (scene.area[f] > 0) points.insert(points.end(), scene.corners[f].begin(), scene.corners[f].end());
  return points;
}

PictureRays::PictureRays(const FacetScene& scene, bool infinite) : all_(scene) {
  if (!scene.periodic || infinite) return;
  cell_scene_ = std::make_unique<FacetScene>(scene);
  cell_scene_->periodic.reset();
  cell_ = std::make_unique<RayScene>(*cell_scene_);
}

Image sample_picture(const Camera& camera, const PictureSettings& settings,
                     const std::function<Rgb(const CameraRay&, std::uint64_t)>& shade, Progress& progress) {
  if (settings.samples < 1 || settings.samples > 4096)
    throw UsageError(fmt::format("--samples: found {}; expected 1 to 4096 per pixel", settings.samples));
  const int strata = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(settings.samples)) - 1e-9));
  Image image(settings.width, settings.height);
  constexpr int band = 16;  // rows between two looks at the clock and the stop signal: about 0.1 s
  for (int top = 0; top < settings.height; top += band) {
    progress.check();
    const int bottom = std::min(settings.height, top + band);
    tbb::parallel_for(tbb::blocked_range2d<int>(top, bottom, band, 0, settings.width, band), [&](const tbb::blocked_range2d<int>& tile) {
      for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
        for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) {
          Rgb sum{0.0f};
          for (int s = 0; s < strata * strata; ++s) {
            const std::uint64_t bits = mix(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(s));
            const double dx = (s % strata + unit_interval(bits)) / strata, dy = (s / strata + unit_interval(mix(bits, 1))) / strata;
            sum += shade(camera.ray((x + dx) / settings.width, (y + dy) / settings.height), mix(bits, 2));
          }
          image.at(x, y) = encode_srgb(sum / static_cast<float>(strata * strata));
        }
    });
    progress.fraction("picture", static_cast<double>(bottom) / settings.height);
  }
  return image;
}

}  // namespace sunfleck
