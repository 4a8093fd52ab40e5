#include <algorithm>
#include <atomic>
#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/picture.hpp>

#include "view/pixel_layers.hpp"
#include "view/sight.hpp"

namespace sunfleck {

namespace {

constexpr double legend_share = 0.17;  ///< of the picture's width

/// Nearly white paper, a little darker below.
Rgb paper(const Vec3& direction) {
  return Rgb{0.90f} + 0.08f * static_cast<float>(std::clamp(0.5 + 0.5 * direction.z, 0.0, 1.0));
}

/// Values of the facets that are seen.
class SeenValues {
 public:
  SeenValues(const MapSource& map, std::size_t coloured, std::size_t most_bytes)
      : map_(map), coloured_(coloured), seen_(coloured, width() * sizeof(float), most_bytes), shown_(map.names.size()) {}

  bool wants_marks() const { return !seen_.all(); }
  void mark(const PlacedHit& hit) {
    if (hit && hit.facet < coloured_) seen_.add(hit.facet);
  }
  void read(Progress& progress) {
    seen_.close();
    values_ = read_seen(seen_, coloured_, width(), map_.values, progress);
  }
  /// NaN where the facet is not coloured. Remembers for the legend what was asked for.
  float of(const PlacedHit& hit, bool front) {
    if (!hit || hit.facet >= coloured_) return std::numeric_limits<float>::quiet_NaN();
    const float value = values_[seen_.row(hit.facet) * width() + (map_.sides && !front ? 1 : 0)];
    const auto note = [](std::atomic<bool>& flag) {
      if (!flag.load(std::memory_order_relaxed)) flag.store(true, std::memory_order_relaxed);
    };
    if (!map_.names.empty()) {
      if (value >= 0 && value < static_cast<float>(shown_.size())) note(shown_[static_cast<std::size_t>(value)]);
    } else {
      const double t = map_.scale.position(value);
      if (t < -1e-6) note(below_);
      if (t > 1 + 1e-6) note(above_);
    }
    return value;
  }
  bool shown(std::size_t name) const { return shown_[name]; }
  bool below() const { return below_; }
  bool above() const { return above_; }

 private:
  std::size_t width() const { return map_.sides ? 2 : 1; }

  const MapSource& map_;
  std::size_t coloured_;
  SeenFacets seen_;
  std::vector<float> values_;
  std::vector<std::atomic<bool>> shown_;  ///< per name
  std::atomic<bool> below_ = false, above_ = false;
};

void draw_legend(Image& image, const Font& font, const PictureSettings& settings, const MapSource& map, const std::vector<Rgb8>& colours,
                 const SeenValues& values) {
  const int margin = static_cast<int>(0.012 * settings.width);
  LegendPlace place{static_cast<int>((1 - legend_share) * settings.width) + margin, static_cast<int>(0.06 * settings.height),
                    static_cast<int>(legend_share * settings.width) - 2 * margin, static_cast<int>(0.88 * settings.height),
                    text_size(settings)};
  image.fill(place.left - margin, 0, settings.width, settings.height, {252, 252, 252});
  if (map.names.empty()) {
    place.height = static_cast<int>(0.62 * settings.height);
    draw_bar(image, font, place, map.title, map.map, map.scale, values.below(), values.above());
    return;
  }
  std::vector<std::string> names;
  std::vector<Rgb8> squares;
  for (std::size_t k = 0; k < map.names.size(); ++k)
    if (values.shown(k)) names.push_back(map.names[k]), squares.push_back(colours[k]);
  draw_list(image, font, place, map.title, names, squares);
}

}  // namespace

Picture draw_map(const DrawnScene& scene, const MapSource& map, const PictureSettings& settings, Progress& progress) {
  const Strata strata(settings);
  const auto views =
      lay_out(settings, scene.outline(), static_cast<int>((1 - legend_share) * settings.width), {.right = 0.97 - legend_share});
  const PlacedRays rays(scene);
  const Sight sight(scene, rays, settings, views);
  SeenValues values(map, settings.map_ground || scene.plant_facets() == 0 ? scene.size() : scene.plant_facets(), settings.most_value_bytes);
  if (values.wants_marks())
    each_pixel(views, "what is seen", progress, [&](const View& view, int x, int y) {
      for (int s = 0; s < strata.count(); ++s) values.mark(sight.hit(strata.sample(view, x, y, s).ray));
    });
  values.read(progress);

  std::vector<Rgb8> colours(map.names.size());
  for (std::size_t k = 0; k < colours.size(); ++k) colours[k] = category_color(k);
  const bool white = settings.background == Background::white;
  const auto shade = [&](const SurfacePoint& at, float value, const Vec3& direction) {
    const float facing = 0.6f + 0.4f * static_cast<float>(std::fabs(glm::dot(at.normal, direction)));
    if (scene.is_ground(at.place) && !settings.map_ground && scene.plant_facets() > 0) return Rgb{0.62f} * facing;
    if (map.names.empty())
      return decode_srgb(color_at(map.map, std::isnan(value) ? static_cast<double>(value) : map.scale.position(value)));
    const auto row = value >= 0 ? static_cast<std::size_t>(value) : colours.size();
    return row < colours.size() ? decode_srgb(colours[row]) * facing : Rgb{0.5f};
  };
  PixelLayers layers(settings, scene, true);
  Picture picture{Image(settings.width, settings.height), std::nullopt};
  each_pixel(views, "picture", progress, [&](const View& view, int x, int y) {
    Rgb sum{0.0f}, seen{0.0f};
    int met = 0;
    for (int s = 0; s < strata.count(); ++s) {
      const auto [ray, bits] = strata.sample(view, x, y, s);
      const auto hit = sight.hit(ray);
      if (!hit) {
        sum += white ? Rgb{1.0f} : paper(ray.direction);
        continue;
      }
      const auto at = rays.surface(hit, ray.direction);
      const float value = values.of(hit, at.front);
      if (s == strata.middle()) layers.middle(x, y, view, ray, hit, value);
      const Rgb colour = shade(at, value, ray.direction);
      sum += colour, seen += colour, ++met;
    }
    const auto count = static_cast<float>(strata.count());
    picture.image.at(x, y) = encode_srgb(sum / count);
    layers.mean(x, y, seen / count, static_cast<float>(met) / count);
  });
  const Font font;
  draw_captions(picture.image, views, settings, font, text_size(settings));
  draw_legend(picture.image, font, settings, map, colours, values);
  picture.layers = layers.take();
  return picture;
}

Image draw_map(const FacetScene& scene, const FacetMap& map, const PictureSettings& settings, Progress& progress) {
  const std::size_t width = map.sides ? 2 : 1;
  if (map.values.size() != width * scene.size()) throw Error("draw_map: values do not match the scene");
  const MapSource source{map.title,
                         map.sides,
                         [&](std::size_t first, std::size_t count) {
                           return std::vector<float>(map.values.begin() + static_cast<std::ptrdiff_t>(first * width),
                                                     map.values.begin() + static_cast<std::ptrdiff_t>((first + count) * width));
                         },
                         map.scale,
                         map.map,
                         map.names};
  return draw_map(DrawnScene(scene), source, settings, progress).image;
}

}  // namespace sunfleck
