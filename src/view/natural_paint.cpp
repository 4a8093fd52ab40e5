#include "view/natural_paint.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

/// Three bands, or one.
std::vector<std::size_t> drawn_bands(const LightSource& light) {
  const ColourBands chosen = light.colours ? *light.colours : colour_bands(light.bands);
  return chosen.measured ? std::vector<std::size_t>(chosen.rgb.begin(), chosen.rgb.end()) : std::vector{chosen.rgb[0]};
}

}  // namespace

NaturalPaint::NaturalPaint(const DrawnScene& scene, const PlacedRays& rays, const LightSource& light, std::size_t most_bytes)
    : scene_(scene),
      rays_(rays),
      light_(light),
      fans_(scene),
      rows_(drawn_bands(light)),
      seen_(scene.size(), 2 * rows_.size() * sizeof(float), most_bytes) {
  if (!light.irradiance || scene.materials().empty()) throw Error("draw_natural: no light, or no materials");
  if (rows_.size() == 3) bands_ = {{0, 1, 2}, true};
  const auto pick = [&](const auto& from) {
    std::vector<float> out;
    for (const auto r : rows_) out.push_back(static_cast<float>(from[r]));
    return out;
  };
  for (const auto& m : scene.materials())
    optics_.push_back({m.name, pick(m.reflectance_front), pick(m.reflectance_back), pick(m.transmittance)});
  for (const auto& entry : scene.geometry().plants) {
    std::vector<std::vector<std::optional<SurfaceKind>>> known(optics_.size(),
                                                               std::vector<std::optional<SurfaceKind>>(entry.plant->types.size()));
    auto& surfaces = surface_.emplace_back();
    for (std::size_t s = 0; s < entry.plant->shapes.size(); ++s) {
      const auto type = entry.plant->structures[entry.plant->shapes[s].structure].type;
      auto& surface = known[entry.shape_optics[s]][type];
      if (!surface) surface = surface_of(entry.plant->types[type], optics_[entry.shape_optics[s]].name);
      surfaces.push_back(*surface);
    }
  }
  if (light.sun && light.sunlit) {
    sun_ = pick(light.sun->irradiance);
    orthonormal_frame(sun_direction_ = light.sun->direction, sun_u_, sun_v_);
    sun_radius_ = std::tan(0.5 * light.sun->angular_diameter_deg * std::numbers::pi / 180.0);
  }
}

const CornerFans::Piece* NaturalPaint::fans(const SurfacePoint& at, double pixel) const {
  const double area = glm::length(area_vector(at.corners));
  return area > pixel * pixel ? fans_.piece(at.place) : nullptr;
}

void NaturalPaint::mark(const PlacedHit& hit, const Vec3& direction, double pixel) {
  if (!hit) return;
  const auto at = rays_.surface(hit, direction);
  const auto* fan = fans(at, pixel);
  seen_.add(hit.facet);
  if (!fan) return;
  const std::size_t first = hit.facet - at.place.triangle;
  for (std::size_t i = fan->begin[3 * at.place.triangle]; i < fan->begin[3 * at.place.triangle + 3]; ++i)
    seen_.add(first + fan->triangle[i]);
}

void NaturalPaint::mark_ground() {
  seen_.add(scene_.plant_facets(), scene_.size() - scene_.plant_facets());
  ground_marked_ = true;
}

void NaturalPaint::read(Progress& progress) {
  seen_.close();
  const std::size_t b = rows_.size(), all = light_.bands.size();
  const auto rest = [&](std::size_t first, std::size_t count) {
    const auto irradiance = light_.irradiance(first, count);
    if (irradiance.size() != 2 * count * all) throw Error("draw_natural: irradiance does not match the scene");
    const auto sunlit = sun_.empty() ? std::vector<float>{} : light_.sunlit(first, count);
    std::vector<float> out(2 * count * b);
    scene_.each_run(first, count, [&](DrawnScene::Place place, std::size_t n, std::size_t at) {
      for (std::size_t i = 0; i < n; ++i, ++place.triangle) {
        const std::size_t f = at + i;
        if (!seen_.has(first + f)) continue;
        double facing = 0;
        if (!sun_.empty()) {
          const Vec3 normal = area_vector(scene_.corners(place));
          const double length = glm::length(normal);
          if (length > 0) facing = glm::dot(normal, sun_direction_) / length;
        }
        for (std::size_t side = 0; side < 2; ++side)
          for (std::size_t k = 0; k < b; ++k) {
            float e = irradiance[(2 * f + side) * all + rows_[k]];
            const double c = side == 0 ? facing : -facing;
            if (c > 0) e = std::max(0.0f, e - sunlit[2 * f + side] * sun_[k] * static_cast<float>(c));
            out[(2 * f + side) * b + k] = e;
          }
      }
    });
    return out;
  };
  rest_ = read_seen(seen_, scene_.size(), 2 * b, rest, progress, light_.block);
  if (ground_marked_) prepare_open_ground();
}

Rgb NaturalPaint::exitance(const PlacedHit& hit, const Vec3& direction, double pixel, std::uint64_t bits) const {
  const std::size_t width = 2 * rows_.size();
  const auto at = rays_.surface(hit, direction);
  std::array<float, 6> irradiance{};
  if (const auto* fan = fans(at, pixel)) {
    // hit.u and hit.v are those of the mesh's corners, as the fans are.
    const std::array<float, 3> weight{1 - hit.u - hit.v, hit.u, hit.v};
    const std::size_t first = hit.facet - at.place.triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<float, 6> sum{};
      float area = 0;
      for (std::size_t i = fan->begin[3 * at.place.triangle + c]; i < fan->begin[3 * at.place.triangle + c + 1]; ++i) {
        const float a = fan->area[fan->triangle[i]];
        const float* value = &rest_[seen_.row(first + fan->triangle[i]) * width];
        area += a;
        for (std::size_t k = 0; k < width; ++k) sum[k] += a * value[k];
      }
      if (area > 0)
        for (std::size_t k = 0; k < width; ++k) irradiance[k] += weight[c] * sum[k] / area;
    }
  } else {
    std::copy_n(&rest_[seen_.row(hit.facet) * width], width, irradiance.begin());
  }
  if (!sun_.empty()) {
    const auto& p = at.corners;
    add_beam((1 - at.u - at.v) * p[0] + at.u * p[1] + at.v * p[2], at.normal, hit.facet, bits, irradiance.data());
  }
  const auto material = scene_.optics(at.place);
  const SurfaceKind surface =
      scene_.is_ground(at.place) ? SurfaceKind::soil : surface_[scene_.geometry().copies[at.place.copy].plant][at.place.shape];
  return facet_colour(bands_, optics_[material], surface, irradiance.data(), at.front ? Side::front : Side::back);
}

void NaturalPaint::prepare_open_ground() {
  const std::size_t width = 2 * rows_.size();
  std::vector<std::pair<float, std::size_t>> cells;
  for (std::size_t f = scene_.plant_facets(); f < scene_.size(); ++f)
    if (glm::length(area_vector(scene_.corners(scene_.place(f)))) > 0) cells.emplace_back(rest_[seen_.row(f) * width], f);
  if (cells.empty()) return;
  std::sort(cells.begin(), cells.end(), std::greater<>());
  cells.resize((cells.size() + 4) / 5);
  open_.fill(0);
  for (const auto& [key, f] : cells)
    for (std::size_t k = 0; k < rows_.size(); ++k) open_[k] += rest_[seen_.row(f) * width + k] / static_cast<float>(cells.size());
}

Rgb NaturalPaint::open_ground(const Vec3& point, std::uint64_t bits) const {
  std::array<float, 6> irradiance = open_;
  if (!sun_.empty()) add_beam(point, {0, 0, 1}, no_placed_facet, bits, irradiance.data());
  return facet_colour(bands_, optics_[scene_.geometry().ground_optics], SurfaceKind::soil, irradiance.data(), Side::front);
}

void NaturalPaint::add_beam(const Vec3& point, const Vec3& normal, std::size_t from, std::uint64_t bits, float* irradiance) const {
  const double cosine = glm::dot(normal, sun_direction_);
  const double r = sun_radius_ * std::sqrt(unit_interval(bits)), angle = 2 * std::numbers::pi * unit_interval(mix(bits, 1));
  const Vec3 towards = glm::normalize(sun_direction_ + r * (std::cos(angle) * sun_u_ + std::sin(angle) * sun_v_));
  if (glm::dot(normal, towards) * cosine <= 0 || rays_.occluded(point, towards, PlacedRays::Part::repeated, from)) return;
  float* side = irradiance + (cosine > 0 ? 0 : rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) side[k] += sun_[k] * static_cast<float>(std::fabs(cosine));
}

Rgb sky_behind(const Vec3& direction, bool sunny) {
  const Rgb zenith = sunny ? Rgb{0.10f, 0.27f, 0.62f} : Rgb{0.50f, 0.55f, 0.60f},
            horizon = sunny ? Rgb{0.62f, 0.77f, 0.90f} : Rgb{0.78f, 0.81f, 0.83f};
  const auto up = static_cast<float>(std::max(0.0, direction.z));
  return glm::mix(horizon, zenith, std::pow(up, 0.55f));
}

}  // namespace sunfleck
