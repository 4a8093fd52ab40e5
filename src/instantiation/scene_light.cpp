#include "instantiation/scene_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/release_memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/light/sky_parts.hpp>
#include <sunfleck/scene/counts.hpp>

#include "instantiation/sun_lines.hpp"

namespace sunfleck {

namespace {

constexpr double most_ground = 16.0;  // area over that of members, beyond which ground weighs less where convergence is judged

constexpr std::uint64_t sun_stream = 0x5a6c3e1f9b7d2048ULL, own_stream = 0x3c8f6a1d5e9b7240ULL, ground_stream = 0x2e8b7a4d1c6f3095ULL;

/// Copies turn their directions as they stand: skies with detail are blurred over what lies between directions.
std::vector<LightState> blurred_states(const std::vector<LightState>& states, std::uint32_t directions) {
  std::vector<LightState> out = states;
  for (std::size_t s = 0; s < out.size(); ++s) {
    if (!out[s].sky) continue;
    std::size_t same = 0;
    while (same < s && !(states[same].sky && same_radiance(*states[same].sky, *states[s].sky))) ++same;
    auto& sky = *out[s].sky;
    if (same < s) {
      const auto irradiance = sky.irradiance;
      sky = *out[same].sky;
      sky.irradiance = irradiance;
    } else {
      sky = blurred(sky, std::sqrt(2.0 / directions));  // the radius of a cell
    }
  }
  return out;
}

}  // namespace

SceneLight::SceneLight(const Scene& a_scene, const PlacedScene& a_placed, const InstantiationSettings& settings, Progress& a_progress)
    : scene(a_scene),
      placed(a_placed),
      density(adapted(settings.density, a_placed.solved_facets())),
      seed(settings.seed),
      progress(a_progress),
      states(a_scene.states.size()),
      bands(a_scene.band_count()),
      columns(states * bands),
      lit_states(blurred_states(a_scene.states, density.fine.directions)),
      lights(light_sources(lit_states)),
      members(
          make_members(a_scene, a_placed, settings.classes, density.coarse, density.elements_per_organ, seed, a_progress, settings.store)),
      store(settings.store) {
  release_freed_memory();
  memory.hold("plants", held_bytes(scene));
  memory.hold("originals", members.bytes());
  memory.pass("originals", members.made_with);
}

std::uint32_t rays_of_ground(const Members& members, const InstantiationDensity& density) {
  const std::size_t facets = members.ground_parts.size() - 1, parts = members.ground_parts.back();
  return parts == 0 ? 8u : std::max(8u, static_cast<std::uint32_t>(std::uint64_t{density.ground_rays} * facets / parts));
}

void SceneLight::project_sun() {
  sun_pitch = sun_pitches(members, density);
  if (!lights.suns.empty()) ground_shade = shading_ground(scene, members);
  CopyScene solved = members.copies;  // what is far shades nothing that is opened
  solved.copies.resize(members.size());
  auto pitch = sun_pitch;
  add_ground_shade(solved, pitch);
  for (const auto* sun : lights.suns) {
    lit.push_back(lit_cells(solved, sun_disc(*sun, density.sun_samples, mix(seed, sun_stream)), pitch, mix(seed, sun_stream, 1), progress));
    sun_fragments += lit.back().fragments;
    std::size_t bytes = ground_shade ? ground_shade->bytes() : 0;
    for (const auto& one : lit) bytes += bytes_of(one.lit);
    memory.hold("sun", bytes);
    memory.pass("sun", bytes + 4 * lit.back().lit.size());  // two counts a cell
  }
}

void SceneLight::add_ground_shade(CopyScene& shade, std::vector<double>& pitch) const {
  if (!ground_shade) return;
  shade.surfaces.push_back(ground_shade.get());
  shade.copies.push_back({static_cast<std::uint32_t>(shade.surfaces.size() - 1), Affine{}});
  pitch.push_back(0.0);
}

void SceneLight::look_around(SolveReport& report) {
  around = std::make_unique<MemberSurroundings>(members);
  const std::size_t n = members.size();
  field_start.assign(n + 1, 0);
  end_start.assign(n + 1, 0);
  for (std::size_t m = 0; m < n; ++m) {
    const auto& op = members.coarse_of(m);
    field_start[m + 1] = field_start[m] + op.fields();
    end_start[m + 1] = end_start[m] + op.points.size();
  }
  ends.resize(end_start.back());
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t m) {
    if (progress.cancelled()) return;
    const auto& op = members.coarse_of(m);
    look_from(static_cast<std::uint32_t>(m), op, 0, op.fields(), ends.data() + end_start[m]);
  });
  progress.check();
  ground = view_from_ground(scene, members.copies.ground, *around, lights, rays_of_ground(members, density), density.sun_samples,
                            mix(seed, ground_stream), progress);
  report.counts.emplace_back("rays", ends.size() + ground.seen.size() * ground.rays);
  memory.hold("rays", around->bytes() + bytes_of(ends) + ground.bytes());
}

std::uint32_t SceneLight::begin_own(std::uint32_t copy) {
  const std::uint32_t plant = placed.plant_of(copy);
  for (std::uint32_t m = 0; m < members.size(); ++m)
    if (members.found.members[m].stands_in && members.found.members[m].copies.front() == copy) gone.push_back(m);
  around->set_hidden(gone, true);
  own_member = static_cast<std::uint32_t>(members.found.members.size());
  members.found.originals.push_back({{{plant, Affine{}}}, placed.plant_facets[plant]});
  Member member;
  member.original = static_cast<std::uint32_t>(members.originals.size());
  member.map = *similarity_of(placed.map_of(copy));
  member.copies = {copy};
  members.found.members.push_back(member);
  members.maps.push_back(member.map);
  members.originals.push_back(original_light(scene, members.approximation, members.found.originals.back(), density.elements_per_organ,
                                             density.coarse, 0.0, seed, progress));
  auto& light = members.originals.back();
  light.coarse = std::make_unique<LineOperator>(light.elements, light.interior, density.fine, mix(seed, own_stream, copy), progress);
  CopyScene shade = members.copies;
  shade.surfaces.push_back(&light.elements.surface);
  shade.copies.resize(members.size());
  for (auto at = gone.rbegin(); at != gone.rend(); ++at) shade.copies.erase(shade.copies.begin() + *at);
  std::vector<double> pitch(shade.copies.size(), 0.0);
  add_ground_shade(shade, pitch);
  double finest = own_sun_pitch(light, member.map, density);  // its pieces were lit by lines as fine as the smallest of them needs
  for (const auto m : gone) finest = std::min(finest, sun_pitch[m]);
  shade.copies.push_back({static_cast<std::uint32_t>(members.originals.size() - 1), member.map.affine()});
  pitch.push_back(finest);
  for (const auto* sun : lights.suns)
    own_lit.push_back(
        lit_cells(shade, sun_disc(*sun, density.sun_samples, mix(seed, sun_stream)), pitch, mix(seed, sun_stream, 1), progress));
  gather_fragments += light.coarse->fragments;
  const std::size_t apart = light.bytes() - light.coarse->bytes();
  std::size_t sun = 0;
  for (const auto& one : own_lit) {
    sun += bytes_of(one.lit);
    sun_fragments += one.fragments;
  }
  memory.pass("fine", apart + light.coarse->built_with());
  memory.hold("fine", light.bytes() + sun);
  return own_member;
}

void SceneLight::end_own() {
  around->set_hidden(gone, false);
  gone.clear();
  own_lit.clear();
  memory.hold("fine", 0);
  members.originals.pop_back();
  members.maps.pop_back();
  members.found.members.pop_back();
  members.found.originals.pop_back();
  own_member = 0xffffffffu;
}

void SceneLight::look_from(std::uint32_t m, const LineOperator& op, std::size_t first_field, std::size_t last_field, RayEnd* out) const {
  const std::size_t pixels = std::size_t{op.pixels()} * op.pixels();
  for (std::size_t f = first_field; f < last_field; ++f) {
    const Vec3 d = members.maps[m].direction(op.direction(f / pixels));
    for (auto k = op.point_start[f]; k < op.point_start[f + 1]; ++k) out[k] = around->look(m, op.points[k], d);
  }
}

float SceneLight::sky_radiance(const Vec3& d, std::size_t column) const {
  const auto k = lights.sky_of_state[column / bands];
  if (k == LightSources::none) return 0.0f;
  return static_cast<float>(std::numbers::pi * lights.skies[k]->relative_radiance(d) *
                            scene.states[column / bands].sky->irradiance[column % bands]);
}

void SceneLight::sun_on_elements(std::uint32_t m, std::size_t sun, std::vector<float>& out) const {
  const auto& e = members.original_of(m).elements;
  const auto& s = e.surface;
  const Vec3 d = members.maps[m].direction_back(lights.suns[sun]->direction);
  const std::uint8_t* cell_lit = lit_cells_of(sun, m);
  out.assign(2 * e.size(), 0.0f);
  for (std::size_t t = 0; t < s.size(); ++t) {
    if (s.split[t] == 0) continue;
    const auto cosine = static_cast<float>(s.normal[0][t] * d.x + s.normal[1][t] * d.y + s.normal[2][t] * d.z);
    const float weight = std::fabs(cosine) * s.cell_area[t] / 255.0f;
    for (auto c = s.first_cell[t]; c < s.first_cell[t + 1]; ++c)
      out[2 * e.element_of_cell[c] + (cosine > 0 ? 0 : 1)] += weight * static_cast<float>(cell_lit[c]);
  }
  const auto& open_area = members.coarse_of(m).open_area;  // what is enclosed is in the dark
  for (std::size_t i = 0; i < out.size(); ++i)
    if (e.area[i / 2] > 0) out[i] /= std::max(open_area[i / 2], 0.05f * e.area[i / 2]);
}

std::vector<float> SceneLight::ground_irradiance(const Light* light, bool direct) const {
  const std::size_t sides = ground.seen.size();
  std::vector<float> out(sides * columns, 0.0f);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, 64), [&](const auto& range) {
    for (std::size_t side = range.begin(); side < range.end(); ++side) {
      if (!ground.seen[side]) continue;
      float* e = out.data() + side * columns;
      if (light) {
        for (std::uint32_t k = 0; k < ground.rays; ++k) {
          const RayEnd& end = ground.ends[ground.first_end(side) + k];
          if (end.is_sky()) continue;
          const float* from = end.is_ground() ? light->ground.data() + (2 * std::size_t{end.facet()} + end.field) * columns
                                              : light->fields.data() + (field_start[end.target] + end.field) * columns;
          for (std::size_t c = 0; c < columns; ++c) e[c] += from[c];
        }
        for (std::size_t c = 0; c < columns; ++c) e[c] /= static_cast<float>(ground.rays);
      }
      if (direct)
        for (std::size_t c = 0; c < columns; ++c) e[c] += ground_direct(side, c);
    }
  });
  return out;
}

float SceneLight::ground_direct(std::size_t side, std::size_t column) const {
  const std::size_t state = column / bands, band = column % bands;
  float e = 0;
  if (const auto k = lights.sky_of_state[state]; k != LightSources::none)
    e += static_cast<float>(scene.states[state].sky->irradiance[band]) * ground.sky[k][side];
  if (const auto k = lights.sun_of_state[state]; k != LightSources::none)
    e += static_cast<float>(scene.states[state].sun->irradiance[band]) * ground.lit[k][side];
  return e;
}

void SceneLight::reflect_from_ground(std::vector<float>& e) const {
  if (!scene.ground) return;
  const auto& optics = scene.ground->optics;
  for (std::size_t f = 0; f + 1 < ground.seen.size(); f += 2)
    for (std::size_t c = 0; c < columns; ++c) {
      const float front = e[f * columns + c], back = e[(f + 1) * columns + c];
      const std::size_t band = c % bands;
      e[f * columns + c] = optics.reflectance_front[band] * front + optics.transmittance[band] * back;
      e[(f + 1) * columns + c] = optics.reflectance_back[band] * back + optics.transmittance[band] * front;
    }
}

std::vector<double> SceneLight::product(const Light& a, const Light& b) const {
  std::vector<double> out(columns, 0.0);
  double of_members = 0.0, of_ground = 0.0;  // areas
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto& op = members.coarse_of(m);
    const double unit = members.maps[m].scale * members.maps[m].scale * op.line_area / op.directions();
    const float *x = a.fields.data() + field_start[m] * columns, *y = b.fields.data() + field_start[m] * columns;
    for (std::size_t f = 0; f < op.fields(); ++f) {
      of_members += unit * op.field_lines[f];
      for (std::size_t c = 0; c < columns; ++c) out[c] += unit * op.field_lines[f] * x[f * columns + c] * y[f * columns + c];
    }
  }
  for (const float area : ground.area) of_ground += area;
  // a kilometre of ground about a few plants must not hide what of these has not converged
  const double weight = of_ground > 0.0 ? std::min(1.0, most_ground * of_members / of_ground) : 1.0;
  for (std::size_t side = 0; side < ground.seen.size(); ++side)
    for (std::size_t c = 0; c < columns; ++c)
      out[c] += weight * ground.area[side / 2] * a.ground[side * columns + c] * b.ground[side * columns + c];
  return out;
}

Light SceneLight::no_light() const {
  return {std::vector<float>(field_start.back() * columns, 0.0f), std::vector<float>(ground.seen.size() * columns, 0.0f)};
}

std::vector<std::uint32_t> SceneLight::all_members() const {
  std::vector<std::uint32_t> out(members.size());
  for (std::uint32_t m = 0; m < out.size(); ++m) out[m] = m;
  return out;
}

}  // namespace sunfleck
