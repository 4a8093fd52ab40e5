#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/picture.hpp>

#include "view/natural_paint.hpp"
#include "view/pixel_layers.hpp"

namespace sunfleck {

namespace {

constexpr int exposure_grid = 160;  ///< rays each way that set the exposure

/// Size of a pixel at a distance [m].
double pixel_size(const View& view, double distance) {
  return 2 * view.camera.half_height() / view.height * (view.camera.orthographic() ? 1.0 : distance);
}

/// Calls ray(view, camera ray, random bits) for a coarse grid over all views.
template <class Ray>
void each_exposure_ray(const std::vector<View>& views, Ray ray) {
  const int grid = std::max(8, exposure_grid / static_cast<int>(std::ceil(std::sqrt(static_cast<double>(views.size())))));
  for (const auto& view : views)
    for (int y = 0; y < grid; ++y)
      for (int x = 0; x < grid; ++x) ray(view, view.ray((x + 0.5) / grid, (y + 0.5) / grid), mix(static_cast<std::uint64_t>(y * grid + x)));
}

}  // namespace

Picture draw_natural(const DrawnScene& scene, const LightSource& light, const PictureSettings& settings, Progress& progress) {
  const Strata strata(settings);
  const auto views = lay_out(settings, scene.outline(), settings.width, {});
  const PlacedRays rays(scene);
  const Sight sight(scene, rays, settings, views);
  NaturalPaint paint(scene, rays, light, settings.most_value_bytes);

  // Decoration: the ground of a scene that does not repeat goes on to the horizon.
  const bool has_ground = scene.plant_facets() < scene.size(), sky = settings.background == Background::sky;
  const bool extended = sky && !scene.geometry().periodic && has_ground;
  const bool repeated = scene.geometry().periodic && settings.infinite;

  if (paint.wants_marks()) {
    each_exposure_ray(views, [&](const View& view, const CameraRay& ray, std::uint64_t) {
      const auto hit = sight.hit(ray);
      paint.mark(hit, ray.direction, pixel_size(view, hit.distance));
    });
    each_pixel(views, "what is seen", progress, [&](const View& view, int x, int y) {
      for (int s = 0; s < strata.count(); ++s) {
        const auto sample = strata.sample(view, x, y, s);
        const auto hit = sight.hit(sample.ray);
        paint.mark(hit, sample.ray.direction, pixel_size(view, hit.distance));
      }
    });
  }
  if (extended) paint.mark_ground();
  paint.read(progress);

  std::vector<float> luminances;
  each_exposure_ray(views, [&](const View& view, const CameraRay& ray, std::uint64_t bits) {
    const auto hit = sight.hit(ray);
    if (hit) luminances.push_back(luminance(paint.exitance(hit, ray.direction, pixel_size(view, hit.distance), bits)));
  });
  Exposure exposure = exposure_for(std::move(luminances));
  exposure.scale *= static_cast<float>(std::exp2(settings.exposure_stops));

  PixelLayers layers(settings, scene, false);
  Picture picture{Image(settings.width, settings.height), std::nullopt};
  const auto haze = [&](const Rgb& near, const Rgb& behind, double distance) {
    return glm::mix(near, behind,
                    static_cast<float>(1 - std::exp(-std::max(0.0, distance - sight.clear_distance()) / sight.haze_distance())));
  };
  each_pixel(views, "picture", progress, [&](const View& view, int x, int y) {
    Rgb sum{0.0f}, seen{0.0f};
    int met = 0;
    for (int s = 0; s < strata.count(); ++s) {
      const auto [ray, bits] = strata.sample(view, x, y, s);
      const auto hit = sight.hit(ray);
      const Rgb behind = sky ? sky_behind(ray.direction, paint.sunny()) : Rgb{1.0f};
      if (s == strata.middle()) layers.middle(x, y, view, ray, hit);
      if (hit) {
        const Rgb light_left = paint.exitance(hit, ray.direction, pixel_size(view, hit.distance), bits);
        seen += light_left, ++met;
        const Rgb colour = tone_map(light_left, exposure);
        sum += repeated ? haze(colour, behind, hit.distance) : colour;
        continue;
      }
      if (!extended || !(ray.direction.z < 0) || !(ray.origin.z > scene.ground_height())) {
        sum += behind;
        continue;
      }
      const double distance = (scene.ground_height() - ray.origin.z) / ray.direction.z;
      sum += haze(tone_map(paint.open_ground(ray.origin + distance * ray.direction, bits), exposure), behind, distance);
    }
    const auto count = static_cast<float>(strata.count());
    picture.image.at(x, y) = encode_srgb(sum / count);
    layers.mean(x, y, seen / count, static_cast<float>(met) / count);
  });
  draw_captions(picture.image, views, settings, Font(), text_size(settings));
  picture.layers = layers.take();
  return picture;
}

LightSource light_source(const StateLight& light, std::size_t facets) {
  const std::size_t b = light.bands.size();
  if (light.irradiance.size() != 2 * facets * b) throw Error("draw_natural: irradiance does not match the scene");
  const auto part = [](const std::vector<float>& all, std::size_t width) {
    return [&all, width](std::size_t first, std::size_t count) {
      return std::vector<float>(all.begin() + static_cast<std::ptrdiff_t>(first * width),
                                all.begin() + static_cast<std::ptrdiff_t>((first + count) * width));
    };
  };
  LightSource source;
  source.bands = light.bands, source.sun = light.sun;
  if (light.band) source.colours = ColourBands{{*light.band, *light.band, *light.band}, false};
  source.irradiance = part(light.irradiance, 2 * b);
  if (light.sunlit.size() == 2 * facets) source.sunlit = part(light.sunlit, 2);
  return source;
}

Image draw_natural(const FacetScene& scene, const StateLight& light, const PictureSettings& settings, Progress& progress) {
  const LightSource source = light_source(light, scene.size());
  return draw_natural(DrawnScene(scene), source, settings, progress).image;
}

}  // namespace sunfleck
