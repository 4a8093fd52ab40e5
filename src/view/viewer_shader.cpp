#include "view/viewer_shader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_sort.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_passed = 4096;  ///< hidden facets along one ray
constexpr float pale = 0.16f;      ///< share of its colour that an unselected facet keeps
constexpr std::size_t ramp_codes = 1024;

Rgb paper(const Vec3& direction, bool dark) {
  const auto up = static_cast<float>(std::clamp(0.5 + 0.5 * direction.z, 0.0, 1.0));
  return dark ? Rgb{0.012f} + 0.01f * up : Rgb{0.90f} + 0.08f * up;
}

/// Even about zero; 2 % of the plants' area may lie outside, so that a few noisy twigs do not pale the rest.
ValueScale even_scale(const ShownMap& shown, const ViewerScene& scene) {
  const auto& facets = scene.scene();
  const std::size_t end = facets.plant_facets > 0 ? facets.plant_facets : facets.size();
  std::vector<std::pair<float, float>> sizes;  // of the difference, and the area that has it
  double area = 0;
  for (std::size_t f = 0; f < end; ++f)
    if (facets.area[f] > 0)
      for (const bool front : {true, false}) sizes.emplace_back(std::fabs(shown.value(f, front)), facets.area[f]), area += facets.area[f];
  tbb::parallel_sort(sizes.begin(), sizes.end());
  double seen = 0, half = 0;
  for (const auto& [size, weight] : sizes) {
    if (half > 0 && seen > 0.98 * area) break;
    half = size, seen += weight;
  }
  return half > 0 && std::isfinite(half) ? ValueScale{-half, half, false} : ValueScale{-1, 1, false};
}

}  // namespace

Rgb8 difference_color(double t) {
  if (std::isnan(t)) return {128, 128, 128};
  t = std::clamp(t, 0.0, 1.0);
  const Rgb low = decode_srgb({59, 76, 192}), middle = decode_srgb({221, 221, 221}), high = decode_srgb({180, 4, 38});
  const auto mixed = t < 0.5 ? glm::mix(low, middle, static_cast<float>(2 * t)) : glm::mix(middle, high, static_cast<float>(2 * t - 1));
  return encode_srgb(mixed);
}

float ShownMap::value(std::size_t facet, bool front) const {
  const auto of = [&](const FacetMap& m) { return m.sides ? m.values[2 * facet + (front ? 0 : 1)] : m.values[facet]; };
  return subtracted ? of(map->map) - of(subtracted->map) : of(map->map);
}

ShownMap shown_map(const ViewerScenes& scenes, std::size_t result, const ShownQuantity& shown, bool logarithmic,
                   const std::optional<std::array<double, 2>>& range) {
  ShownMap out;
  out.map = scenes.at(shown.difference ? 1 : result)->map(shown.quantity, shown.band, shown.state);
  if (shown.difference) {
    if (!out.map->map.names.empty()) throw UsageError("difference: found names; expected a quantity with numbers");
    out.subtracted = scenes[0]->map(shown.quantity, shown.band, shown.state);
    out.diverging = true;
    out.scale = range ? ValueScale{(*range)[0], (*range)[1], false} : even_scale(out, *scenes[0]);
    return out;
  }
  out.scale = range ? ValueScale{(*range)[0], (*range)[1], logarithmic} : logarithmic ? out.map->logarithmic : out.map->linear;
  return out;
}

ViewerShader::ViewerShader(const ViewerScenes& scenes, const ViewerView& view, bool quick)
    : scene_(*scenes.at(view.result)), view_(view), colour_(view.shown.quantity == "colour") {
  const auto& facets = scene_.scene();
  selected_ = selected_organs(facets, view.selection);
  choosy_ = !view.selection.empty();
  fine_ = !quick && scene_.exact();
  if (!colour_) {
    shown_ = shown_map(scenes, view.result, view.shown, view.logarithmic, view.range);
    if (shown_.map->map.names.empty())
      for (std::size_t k = 0; k < ramp_codes; ++k) {
        const double t = static_cast<double>(k) / (ramp_codes - 1);
        ramp_.push_back(decode_srgb(shown_.diverging ? difference_color(t) : color_at(view.map, t)));
      }
    for (std::size_t k = 0; k < shown_.map->map.names.size(); ++k) categories_.push_back(decode_srgb(category_color(k)));
    return;
  }
  light_ = scene_.light(view.shown.state);
  if (!quick) natural_ = scene_.natural(view.shown.state);
  fine_ = natural_ != nullptr;
  open_ground_ = natural_ && view.ground && !facets.periodic && facets.plant_facets < facets.size();
  ground_height_ = infinity;
  for (std::size_t f = facets.plant_facets; f < facets.size(); ++f)
    for (const auto& p : facets.corners[f]) ground_height_ = std::min(ground_height_, p.z);
  const auto& camera = view.camera;
  pixel_ =
      2 * std::tan(0.5 * camera.field_of_view_deg * std::numbers::pi / 180) * (camera.orthographic ? camera.distance : 1.0) / view.height;
  expose();
}

/// One exposure for all views of a light, so that a turn of the camera does not change the brightness: from a sample of the facets' fronts.
void ViewerShader::expose() {
  const auto& facets = scene_.scene();
  const std::size_t n = facets.size(), b = light_->stored.bands.size(), step = n / 20000 + 1;
  std::vector<float> luminances;
  for (std::size_t f = 0; f < n; f += step) {
    if (!(facets.area[f] > 0)) continue;
    const auto& surfaces = light_->surfaces[facets.optics[f]];
    const SurfaceKind surface = f >= facets.plant_facets ? SurfaceKind::soil : surfaces[facets.organs.type[facets.organ[f]]];
    luminances.push_back(luminance(
        facet_colour(light_->bands, facets.materials[facets.optics[f]], surface, &light_->stored.irradiance[2 * f * b], Side::front)));
  }
  exposure_ = exposure_for(std::move(luminances));
  exposure_.scale *= static_cast<float>(std::exp2(view_.exposure_stops));
}

RayHit ViewerShader::first_shown(const CameraRay& ray) const {
  double from = 0, to = infinity;
  if (view_.cut) {
    const double slope = glm::dot(view_.cut->normal, ray.direction), above = glm::dot(view_.cut->normal, ray.origin) - view_.cut->offset;
    if (slope < 0)
      from = std::max(0.0, -above / slope);
    else if (above > 0)
      return {};
    else if (slope > 0)
      to = -above / slope;
  }
  const auto& facets = scene_.scene();
  const bool hides = (choosy_ && view_.only_selected) || !view_.ground;
  std::uint32_t start = no_facet;
  for (int passed = 0; passed < most_passed && from < to; ++passed) {
    RayHit hit = scene_.first_hit(ray.origin + from * ray.direction, ray.direction, start, to - from, view_.infinite);
    if (!hit) return hit;
    hit.distance += from;
    const bool ground = hit.facet >= facets.plant_facets;
    if (!hides || ((view_.ground || !ground) && (!choosy_ || !view_.only_selected || selected_[facets.organ[hit.facet]]))) return hit;
    from = hit.distance, start = hit.facet;
  }
  return {};
}

Rgb ViewerShader::operator()(const CameraRay& ray, std::uint64_t bits, std::uint32_t& facet) const {
  const RayHit hit = first_shown(ray);
  facet = hit.facet;
  if (!hit) return background(ray, bits);
  const Rgb colour = colour_ ? natural(hit, ray.direction, bits) : mapped(hit, ray.direction);
  if (!choosy_ || selected_[scene_.scene().organ[hit.facet]]) return colour;
  const auto grey =
      Rgb{view_.dark ? 0.08f : 0.72f} * (0.6f + 0.4f * static_cast<float>(std::fabs(glm::dot(scene_.normal(hit.facet), ray.direction))));
  return glm::mix(grey, colour, pale);
}

Rgb ViewerShader::natural(const RayHit& hit, const Vec3& direction, std::uint64_t bits) const {
  if (natural_) {
    const PlacedHit met{hit.facet, static_cast<float>(hit.u), static_cast<float>(hit.v), hit.distance};
    return tone_map(natural_->exitance(met, direction, view_.camera.orthographic ? pixel_ : pixel_ * hit.distance, bits), exposure_);
  }
  const auto& facets = scene_.scene();
  const std::size_t f = hit.facet, b = light_->stored.bands.size();
  const auto& surfaces = light_->surfaces[facets.optics[f]];
  const SurfaceKind surface = f >= facets.plant_facets ? SurfaceKind::soil : surfaces[facets.organs.type[facets.organ[f]]];
  return tone_map(facet_colour(light_->bands, facets.materials[facets.optics[f]], surface, &light_->stored.irradiance[2 * f * b],
                               hit.front ? Side::front : Side::back),
                  exposure_);
}

Rgb ViewerShader::mapped(const RayHit& hit, const Vec3& direction) const {
  const float facing = 0.6f + 0.4f * static_cast<float>(std::fabs(glm::dot(scene_.normal(hit.facet), direction)));
  if (hit.facet >= scene_.scene().plant_facets && !view_.map_ground && scene_.scene().plant_facets > 0)
    return Rgb{view_.dark ? 0.16f : 0.62f} * facing;
  const float value = shown_.value(hit.facet, hit.front);
  if (!categories_.empty()) {
    const auto row = static_cast<std::size_t>(value);
    return row < categories_.size() ? categories_[row] * facing : Rgb{0.5f};
  }
  if (std::isnan(value)) return decode_srgb({128, 128, 128});
  const double t = std::clamp(shown_.scale.position(value), 0.0, 1.0);
  return ramp_[static_cast<std::size_t>(std::lround(t * (ramp_codes - 1)))];
}

Rgb ViewerShader::background(const CameraRay& ray, std::uint64_t bits) const {
  if (!colour_) return paper(ray.direction, view_.dark);
  const bool sunny = light_->stored.sun.has_value();
  const Rgb sky = sky_behind(ray.direction, sunny);
  if (!open_ground_ || !(ray.direction.z < 0) || !(ray.origin.z > ground_height_)) return sky;
  const double size = glm::length(scene_.scene().bounds.size());
  const double distance = (ground_height_ - ray.origin.z) / ray.direction.z;
  if (view_.cut && glm::dot(view_.cut->normal, ray.origin + distance * ray.direction) > view_.cut->offset) return sky;
  const double clear = glm::length(ray.origin - scene_.scene().bounds.centre());
  const Rgb ground = tone_map(natural_->open_ground(ray.origin + distance * ray.direction, bits), exposure_);
  return glm::mix(ground, sky, static_cast<float>(1 - std::exp(-std::max(0.0, distance - clear) / (28 * size))));
}

}  // namespace sunfleck
