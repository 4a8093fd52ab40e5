// Small scenes in memory and a sink that keeps what the reference method says of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/kept_light.hpp>

namespace reference_runs {

using namespace sunfleck;

using Kept = KeptLight;

struct Run {
  FacetScene facets;
  Kept kept;
  SolveReport report;

  double absorbed(std::size_t facet, std::size_t band = 0, std::size_t state = 0) const {
    const auto& m = facets.materials[facets.optics[facet]];
    return (1.0 - m.reflectance_front[band] - m.transmittance[band]) * kept.on(facet, 0, band, state) +
           (1.0 - m.reflectance_back[band] - m.transmittance[band]) * kept.on(facet, 1, band, state);
  }
  double standard_error(std::size_t facet, std::size_t band = 0, std::size_t state = 0) const {
    return std::sqrt(kept.variance_of(facet, band, state));
  }
};

inline Run trace(const Scene& scene, std::uint32_t samples, std::uint64_t seed = 1, int threads = 0) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  ReferenceSettings settings;
  settings.samples = samples;
  settings.seed = seed;
  settings.threads = threads;
  auto report = trace_reference(scene, facets, settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

inline Scene scene_with(std::vector<std::string> bands, std::vector<Optics> optics) {
  Scene scene;
  scene.bands = std::move(bands);
  scene.band_units.assign(scene.bands.size(), "W m^-2");
  scene.optics = std::move(optics);
  scene.states.resize(1);
  return scene;
}

inline void point_sun(Scene& scene, const Vec3& direction, double irradiance) {
  Sun sun;
  sun.direction = glm::normalize(direction);
  sun.irradiance.assign(scene.bands.size(), irradiance);
  sun.angular_diameter_deg = 0;
  scene.states[0].sun = sun;
}

inline void sky(Scene& scene, SkyModel model, double irradiance) {
  Sky s;
  s.model = model;
  s.irradiance.assign(scene.bands.size(), irradiance);
  scene.states[0].sky = s;
}

inline void add(Scene& scene, const std::string& name, std::vector<Mesh> meshes, std::uint32_t optics) {
  scene.plants.push_back(plant_entry(name, make_plant(std::move(meshes), name), optics, {placed({})}));
}

/// Two triangles, front up.
inline Mesh square(double z, double size = 1.0) {
  return {{{0, 0, z}, {size, 0, z}, {size, size, z}, {0, size, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Square leaves of random place and spherical angles in a box, one mesh (organ) each; they keep within its height.
inline std::vector<Mesh> leaves(int n, double side, const Vec3& box, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Mesh> out;
  for (int i = 0; i < n; ++i) {
    const Vec3 c{random.next() * box.x, random.next() * box.y, side + random.next() * (box.z - 2 * side)};
    const double z = 2 * random.next() - 1, azimuth = 2 * std::numbers::pi * random.next(), s = std::sqrt(1 - z * z);
    Vec3 u, v;
    orthonormal_frame({s * std::cos(azimuth), s * std::sin(azimuth), z}, u, v);
    u *= 0.5 * side, v *= 0.5 * side;
    out.push_back({{c - u - v, c + u - v, c + u + v, c - u + v}, {{0, 1, 2}, {0, 2, 3}}});
  }
  return out;
}

}  // namespace reference_runs
