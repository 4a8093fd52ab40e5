#include "view/natural_light.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>

#include "view/picture_frame.hpp"
#include "view/smooth.hpp"

namespace sunfleck {

NaturalLight::NaturalLight(const FacetScene& scene, const FacetLight& light, const RayScene& rays) : scene_(scene), rays_(rays) {
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
    for (const auto r : rows) sun_.push_back(static_cast<float>(light.sun->irradiance[r]));
    sunlit_ = light.sunlit;
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

Rgb NaturalLight::exitance(const RayHit& hit, std::uint64_t bits, Beam beam) const {
  const std::size_t f = hit.facet;
  const double u = hit.u, v = hit.v;
  const std::array<float, 3> weight{static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v)};
  std::array<float, 6> irradiance{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < 2 * b_; ++k) irradiance[k] += weight[c] * rest_[(3 * f + c) * 2 * b_ + k];
  if (!sun_.empty() && beam == Beam::mean) {
    add_mean_beam(normals_[f], {sunlit_[2 * f], sunlit_[2 * f + 1]}, irradiance.data());
  } else if (!sun_.empty()) {
    const auto& p = scene_.corners[f];
    const Vec3 point = (1 - u - v) * p[0] + u * p[1] + v * p[2];
    add_traced_beam(point, normals_[f], hit.facet, bits, irradiance.data());
  }
  return facet_colour(bands_, optics_[scene_.optics[f]], surfaces_[f], irradiance.data(), hit.front ? Side::front : Side::back);
}

void NaturalLight::prepare_open_ground() {
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

Rgb NaturalLight::open_ground(const Vec3& point, std::uint64_t bits, Beam beam) const {
  std::array<float, 6> irradiance = open_;
  if (!sun_.empty() && beam == Beam::mean) add_mean_beam({0, 0, 1}, {1, 0}, irradiance.data());
  if (!sun_.empty() && beam == Beam::traced) add_traced_beam(point, {0, 0, 1}, no_facet, bits, irradiance.data());
  return facet_colour(bands_, optics_[ground_material_], Surface::soil, irradiance.data(), Side::front);
}

void NaturalLight::add_traced_beam(const Vec3& point, const Vec3& normal, std::uint32_t from, std::uint64_t bits, float* irradiance) const {
  const double cosine = glm::dot(normal, sun_direction_);
  const double r = sun_radius_ * std::sqrt(unit_interval(bits)), angle = 2 * std::numbers::pi * unit_interval(mix(bits, 1));
  const Vec3 towards = glm::normalize(sun_direction_ + r * (std::cos(angle) * sun_u_ + std::sin(angle) * sun_v_));
  if (glm::dot(normal, towards) * cosine <= 0 || rays_.occluded(point, towards, from)) return;
  float* side = irradiance + (cosine > 0 ? 0 : b_);
  for (std::size_t k = 0; k < b_; ++k) side[k] += sun_[k] * static_cast<float>(std::fabs(cosine));
}

void NaturalLight::add_mean_beam(const Vec3& normal, const std::array<float, 2>& sunlit, float* irradiance) const {
  const double cosine = glm::dot(normal, sun_direction_);
  const std::size_t side = cosine > 0 ? 0 : 1;
  for (std::size_t k = 0; k < b_; ++k) irradiance[side * b_ + k] += sunlit[side] * sun_[k] * static_cast<float>(std::fabs(cosine));
}

Rgb sky_behind(const Vec3& direction, bool sunny) {
  const Rgb zenith = sunny ? Rgb{0.10f, 0.27f, 0.62f} : Rgb{0.50f, 0.55f, 0.60f},
            horizon = sunny ? Rgb{0.62f, 0.77f, 0.90f} : Rgb{0.78f, 0.81f, 0.83f};
  const auto up = static_cast<float>(std::max(0.0, direction.z));
  return glm::mix(horizon, zenith, std::pow(up, 0.55f));
}

}  // namespace sunfleck
