#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/view/colour.hpp>
#include <sunfleck/view/picture.hpp>

#include "view/picture_frame.hpp"
#include "view/smooth.hpp"

namespace sunfleck {

namespace {

/// The stored light reduced to the bands that are drawn, the sun's mean share taken out of it where its beam is traced.
class NaturalLight {
 public:
  NaturalLight(const FacetScene& scene, const FacetLight& light, const RayScene& rays) : scene_(scene), rays_(rays) {
    const std::size_t n = scene.size(), all = light.bands.size();
    if (light.irradiance.size() != 2 * n * all || scene.materials.empty()) throw Error("draw_natural: irradiance does not match the scene");
    const ColourBands chosen = light.band ? ColourBands{{*light.band, *light.band, *light.band}, false} : colour_bands(light.bands);
    const std::vector<std::size_t> rows =
        chosen.measured ? std::vector<std::size_t>(chosen.rgb.begin(), chosen.rgb.end()) : std::vector{chosen.rgb[0]};
    b_ = rows.size();
    bands_ = chosen.measured ? ColourBands{{0, 1, 2}, true} : ColourBands{};
    const auto pick = [&](const std::vector<float>& from) {
      std::vector<float> out;
      for (const auto r : rows) out.push_back(from[r]);
      return out;
    };
    for (const auto& m : scene.materials)
      optics_.push_back({m.name, pick(m.reflectance_front), pick(m.reflectance_back), pick(m.transmittance)});
    surfaces_.reserve(n);
    std::vector<std::vector<Surface>> known(scene.materials.size(), std::vector<Surface>(scene.organs.types.size()));
    for (std::size_t m = 0; m < known.size(); ++m)
      for (std::size_t t = 0; t < known[m].size(); ++t) known[m][t] = surface_of(scene.organs.types[t], scene.materials[m].name);
    for (std::size_t f = 0; f < n; ++f)
      surfaces_.push_back(f >= scene.plant_facets ? Surface::soil : known[scene.optics[f]][scene.organs.type[scene.organ[f]]]);

    normals_.reserve(n);
    for (const auto& c : scene.corners) normals_.push_back(front_normal(c));
    if (light.sun && light.sunlit.size() == 2 * n) {
      sun_ = pick_sun(*light.sun, rows);
      orthonormal_frame(sun_direction_ = light.sun->direction, sun_u_, sun_v_);
      sun_radius_ = std::tan(0.5 * light.sun->angular_diameter_deg * std::numbers::pi / 180.0);
    }
    std::vector<float> rest(2 * n * b_);
    for (std::size_t f = 0; f < n; ++f)
      for (std::size_t side = 0; side < 2; ++side) {
        const double facing = glm::dot(normals_[f], sun_direction_) * (side == 0 ? 1 : -1);
        for (std::size_t k = 0; k < b_; ++k) {
          float e = light.irradiance[(2 * f + side) * all + rows[k]];
          if (!sun_.empty() && facing > 0) e = std::max(0.0f, e - light.sunlit[2 * f + side] * sun_[k] * static_cast<float>(facing));
          rest[(2 * f + side) * b_ + k] = e;
        }
      }
    rest_ = smooth_over_organs(scene, normals_, rest, 2 * b_);
  }

  /// Light that leaves the point and side that a camera ray meets.
  Rgb exitance(const RayHit& hit, std::uint64_t bits) const {
    const std::size_t f = hit.facet;
    const double u = hit.u, v = hit.v;
    const std::array<float, 3> weight{static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v)};
    std::array<float, 6> irradiance{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 2 * b_; ++k) irradiance[k] += weight[c] * rest_[(3 * f + c) * 2 * b_ + k];
    if (!sun_.empty()) {
      const auto& p = scene_.corners[f];
      const Vec3 point = (1 - u - v) * p[0] + u * p[1] + v * p[2];
      add_beam(point, normals_[f], hit.facet, bits, irradiance.data());
    }
    return facet_colour(bands_, optics_[scene_.optics[f]], surfaces_[f], irradiance.data(), hit.front ? Side::front : Side::back);
  }

  /// Ground that nothing but the drawn scene shades: mean diffuse light of the brightest fifth of the ground's cells, and the beam.
  void prepare_open_ground() {
    std::vector<std::pair<float, std::uint32_t>> cells;
    for (std::size_t f = scene_.plant_facets; f < scene_.size(); ++f)
      if (scene_.area[f] > 0) cells.emplace_back(rest_[3 * f * 2 * b_] + rest_[(3 * f + 1) * 2 * b_], static_cast<std::uint32_t>(f));
    if (cells.empty()) return;
    std::sort(cells.begin(), cells.end(), std::greater<>());
    cells.resize((cells.size() + 4) / 5);
    open_.fill(0);
    for (const auto& [key, f] : cells)
      for (std::size_t k = 0; k < b_; ++k) open_[k] += rest_[3 * f * 2 * b_ + k] / static_cast<float>(cells.size());
    ground_material_ = scene_.optics[cells.front().second];
  }
  Rgb open_ground(const Vec3& point, std::uint64_t bits) const {
    std::array<float, 6> irradiance = open_;
    if (!sun_.empty()) add_beam(point, {0, 0, 1}, no_facet, bits, irradiance.data());
    return facet_colour(bands_, optics_[ground_material_], Surface::soil, irradiance.data(), Side::front);
  }

  bool sunny() const { return !sun_.empty(); }

 private:
  static std::vector<float> pick_sun(const Sun& sun, const std::vector<std::size_t>& rows) {
    std::vector<float> out;
    for (const auto r : rows) out.push_back(static_cast<float>(sun.irradiance[r]));
    return out;
  }

  void add_beam(const Vec3& point, const Vec3& normal, std::uint32_t from, std::uint64_t bits, float* irradiance) const {
    const double cosine = glm::dot(normal, sun_direction_);
    const double r = sun_radius_ * std::sqrt(unit_interval(bits)), angle = 2 * std::numbers::pi * unit_interval(mix(bits, 1));
    const Vec3 towards = glm::normalize(sun_direction_ + r * (std::cos(angle) * sun_u_ + std::sin(angle) * sun_v_));
    if (glm::dot(normal, towards) * cosine <= 0 || rays_.occluded(point, towards, from)) return;
    float* side = irradiance + (cosine > 0 ? 0 : b_);
    for (std::size_t k = 0; k < b_; ++k) side[k] += sun_[k] * static_cast<float>(std::fabs(cosine));
  }

  const FacetScene& scene_;
  const RayScene& rays_;
  std::size_t b_ = 1;  ///< bands drawn: 3 or 1
  ColourBands bands_;
  std::vector<Optics> optics_;
  std::vector<Surface> surfaces_;
  std::vector<Vec3> normals_;
  std::vector<float> rest_;  ///< [n][3 corners][2][b_] irradiance without the sun's beam where that is traced
  std::vector<float> sun_;   ///< [b_] on a plane that faces it; empty = not traced
  Vec3 sun_direction_{0, 0, 1}, sun_u_{1, 0, 0}, sun_v_{0, 1, 0};
  double sun_radius_ = 0;
  std::array<float, 6> open_{};
  std::uint32_t ground_material_ = 0;
};

/// Sky behind the scene, display light: decoration only.
Rgb sky_behind(const Vec3& direction, bool sunny) {
  const Rgb zenith = sunny ? Rgb{0.10f, 0.27f, 0.62f} : Rgb{0.50f, 0.55f, 0.60f},
            horizon = sunny ? Rgb{0.62f, 0.77f, 0.90f} : Rgb{0.78f, 0.81f, 0.83f};
  const auto up = static_cast<float>(std::max(0.0, direction.z));
  return glm::mix(horizon, zenith, std::pow(up, 0.55f));
}

}  // namespace

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
