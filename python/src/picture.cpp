#include "picture.hpp"

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/placed_scene.hpp>
#include <sunfleck/view/picture.hpp>
#include <sunfleck/view/stored.hpp>

namespace sunfleck::python {

namespace {

PictureSettings settings_of(const PictureSize& size) {
  PictureSettings settings;
  settings.width = size.width, settings.height = size.height, settings.samples = size.samples;
  return settings;
}

}  // namespace

std::string picture_of_scene(const Scene& scene, const Depth& depth, const std::vector<float>& irradiance, const std::vector<float>& sunlit,
                             std::size_t state, const PictureSize& size, Progress& progress) {
  const PlacedScene placed = place(scene, depth);
  const DrawnScene drawn(scene, placed);
  const std::size_t n = drawn.size(), width = 2 * scene.band_count();
  if (irradiance.size() != scene.states.size() * n * width)
    throw UsageError("picture: found no light of facets; expected a solve with facets=True");
  LightSource light;
  light.bands = scene.bands;
  const auto part = [](const std::vector<float>& all, std::size_t first, std::size_t count) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  light.irradiance = [&, part](std::size_t first, std::size_t count) {
    return part(irradiance, (state * n + first) * width, count * width);
  };
  if (scene.states[state].sun) {
    light.sun = *scene.states[state].sun;
    light.sunlit = [&, part](std::size_t first, std::size_t count) { return part(sunlit, (state * n + first) * 2, count * 2); };
  }
  return png_bytes(draw_natural(drawn, light, settings_of(size), progress).image);
}

std::string picture_of_file(const std::string& file, std::size_t state, const PictureSize& size, Progress& progress) {
  const Result result(file);
  const DrawnScene drawn(result);
  return png_bytes(draw_natural(drawn, stored_light(result, drawn, state), settings_of(size), progress).image);
}

}  // namespace sunfleck::python
