#include <algorithm>
#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/picture.hpp>

#include "view/picture_frame.hpp"

namespace sunfleck {

namespace {

constexpr double legend_share = 0.17;  ///< of the picture's width

/// Height of a text line that suits the picture [pixels].
double text_size(const PictureSettings& s) {
  return std::clamp(0.024 * std::min<double>(s.height, 0.9 * s.width), 9.0, 60.0);
}

/// Nearly white paper, a little darker below.
Rgb paper(const Vec3& direction) {
  return Rgb{0.90f} + 0.08f * static_cast<float>(std::clamp(0.5 + 0.5 * direction.z, 0.0, 1.0));
}

}  // namespace

Image draw_map(const FacetScene& scene, const FacetMap& map, const PictureSettings& settings, Progress& progress) {
  const std::size_t n = scene.size();
  if (map.values.size() != (map.sides ? 2 * n : n)) throw Error("draw_map: values do not match the scene");
  const std::size_t end = settings.map_ground || scene.plant_facets == 0 ? n : scene.plant_facets;  ///< facets that are coloured
  const PictureRays rays(scene, settings.infinite);
  const auto points = framed_points(scene);
  const Camera camera(settings.camera, points, static_cast<double>(settings.width) / settings.height, {.right = 0.97 - legend_share});

  std::vector<Rgb8> colours(map.names.size());
  for (std::size_t k = 0; k < colours.size(); ++k) colours[k] = category_color(k);
  const auto shade = [&](const CameraRay& ray, std::uint64_t) {
    const auto hit = rays.camera().first_hit(ray.origin, ray.direction);
    if (!hit) return paper(ray.direction);
    const double cosine = glm::dot(front_normal(scene.corners[hit.facet]), ray.direction);
    const float facing = 0.6f + 0.4f * static_cast<float>(std::fabs(cosine));
    if (hit.facet >= end) return Rgb{0.62f} * facing;
    const float value = map.sides ? map.values[2 * std::size_t{hit.facet} + (hit.front ? 0 : 1)] : map.values[hit.facet];
    if (map.names.empty())
      return decode_srgb(color_at(map.map, std::isnan(value) ? static_cast<double>(value) : map.scale.position(value)));
    const auto row = static_cast<std::size_t>(value);
    return row < colours.size() ? decode_srgb(colours[row]) * facing : Rgb{0.5f};
  };
  Image image = sample_picture(camera, settings, shade, progress);

  const int margin = static_cast<int>(0.012 * settings.width);
  const double size = text_size(settings);
  LegendPlace place{static_cast<int>((1 - legend_share) * settings.width) + margin, static_cast<int>(0.06 * settings.height),
                    static_cast<int>(legend_share * settings.width) - 2 * margin, static_cast<int>(0.88 * settings.height), size};
  if (map.names.empty()) place.height = static_cast<int>(0.62 * settings.height);
  image.fill(place.left - margin, 0, settings.width, settings.height, {252, 252, 252});
  const Font font;
  if (!map.names.empty()) {
    // Only names of what is coloured.
    std::vector<bool> used(map.names.size());
    for (std::size_t f = 0; f < end; ++f)
      if (const auto row = static_cast<std::size_t>(map.values[f]); row < used.size()) used[row] = true;
    std::vector<std::string> names;
    std::vector<Rgb8> squares;
    for (std::size_t k = 0; k < used.size(); ++k)
      if (used[k]) names.push_back(map.names[k]), squares.push_back(colours[k]);
    draw_list(image, font, place, map.title, names, squares);
    return image;
  }
  bool below = false, above = false;
  for (std::size_t f = 0; f < end; ++f)
    for (std::size_t s = 0; s < (map.sides ? 2u : 1u) && scene.area[f] > 0; ++s) {
      const double t = map.scale.position(map.values[map.sides ? 2 * f + s : f]);
      below |= t<-1e-6, above |= t> 1 + 1e-6;
    }
  draw_bar(image, font, place, map.title, map.map, map.scale, below, above);
  return image;
}

}  // namespace sunfleck
