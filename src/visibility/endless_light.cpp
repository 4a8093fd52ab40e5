#include <sunfleck/visibility/endless_light.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/cosine_direction.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr int particles = 16, most_bounces = 100000;
constexpr float rounding = 1e-6f;  // of sums such as 0.45 + 0.55 in single precision

bool absorbs(const Optics& m, std::size_t band, bool front) {
  return (front ? m.reflectance_front : m.reflectance_back)[band] + m.transmittance[band] < 1.0f - rounding;
}

/// Does a particle go on and on?
bool endless(const RayScene& rays, std::size_t band, Vec3 p, Vec3 d, RandomStream random) {
  CopyFacet facet = nowhere;
  for (int bounce = 0; bounce < most_bounces; ++bounce) {
    const RayHit hit = rays.first_hit(p, d, facet);
    if (!hit) return false;
    facet = hit.where();
    const auto& m = rays.materials()[rays.material(facet)];
    if (absorbs(m, band, hit.front)) return false;
    const Triangle c = rays.met_corners(facet);
    p = c[0] + hit.u * (c[1] - c[0]) + hit.v * (c[2] - c[0]);
    const bool reflected = random.next() >= double{m.transmittance[band]};
    const Vec3 n = glm::normalize(area_vector(c)) * (hit.front == reflected ? 1.0 : -1.0);
    const double u = random.next();
    d = cosine_direction(n, u, random.next());
  }
  return true;
}

}  // namespace

void check_lamplight_ends(const Scene& scene, const RayScene& rays) {
  if (scene.lamps.empty()) return;
  const Lamps lamps = place_lamps(scene);
  for (std::size_t band = 0; band < scene.band_count(); ++band) {
    const bool white = std::any_of(rays.materials().begin(), rays.materials().end(),
                                   [&](const Optics& m) { return !absorbs(m, band, true) || !absorbs(m, band, false); });
    if (!white) continue;
    for (std::uint32_t e = 0; e < scene.lamps.size(); ++e) {
      const bool shines = std::any_of(lamps.sets.begin(), lamps.sets.end(), [&](const std::vector<bool>& set) { return set[e]; });
      if (!shines || !(scene.lamps[e].strength[band] > 0.0)) continue;
      Lamps one;  // this lamp alone
      for (const auto& unit : lamps.units) one.units.push_back(unit);
      for (const auto& face : lamps.faces)
        if (lamps.units[face.unit].entry == e) one.faces.push_back(face);
      for (const auto& beam : lamps.beams)
        if (lamps.units[beam.unit].entry == e) one.beams.push_back(beam);
      const LampEmission emission(one);
      const Vec3 size = rays.bounds().size();
      const double clearance = 4e-6 * std::max({size.x, size.y, size.z});  // from a ceiling in which the lamp lies
      for (int i = 0; i < particles; ++i) {
        RandomStream random(mix(0x656e64ULL, e, static_cast<std::uint64_t>(i)));
        double x[5];
        for (auto& value : x) value = random.next();
        const auto particle = emission.draw(x);
        if (!(particle.weight > 0.0) || !endless(rays, band, particle.from + clearance * particle.direction, particle.direction, random))
          continue;
        throw InputError(
            location(scene.file, 0, fmt::format("lamp[{}]", e)),
            fmt::format("light of band \"{}\" that never ends: in {} reflections it met nothing that absorbs, and no way out",
                        scene.bands[band], most_bounces),
            "reflectance + transmittance below 1 somewhere in the cavity that holds the lamp, or an opening: without, light grows "
            "without bound and there is no solution");
      }
    }
  }
}

}  // namespace sunfleck
