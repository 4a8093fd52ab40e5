#include <sunfleck/scene/lamp_shares.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;

void add_mesh_copy(const LampEntry& entry, const Affine& map, Lamps& lamps) {
  auto& unit = lamps.units.back();
  const auto row = static_cast<std::uint32_t>(lamps.units.size() - 1);
  double area = 0.0;
  for (std::size_t t = 0; t < entry.mesh.triangles.size(); ++t) {
    Triangle c = entry.mesh.corners(t);
    for (auto& p : c) p = map.point(p);
    if (map.mirrors()) std::swap(c[1], c[2]);
    const Vec3 n = area_vector(c);
    const double a = glm::length(n);
    if (!(a > 0.0)) continue;
    lamps.faces.push_back({c, n / a, a, row});
    area += a;
  }
  unit.exitance = unit.power = entry.strength;
  if (entry.by_power)
    for (auto& m : unit.exitance) m /= area;
  else
    for (auto& p : unit.power) p *= area;
}

void add_beam(const LampEntry& entry, const Affine& map, Lamps& lamps) {
  lamps.units.back().power = entry.strength;
  const auto& p = *entry.photometry;
  Mat3 turn = map.linear;  // a turn times a scale, perhaps mirrored
  for (int k = 0; k < 3; ++k) turn[k] = glm::normalize(turn[k]);
  lamps.beams.push_back({map.translation, map.linear[0] * p.length_m, map.linear[1] * p.width_m, glm::transpose(turn), &p,
                         static_cast<std::uint32_t>(lamps.units.size() - 1)});
}

}  // namespace

Vec3 Lamps::Beam::point(double u, double v) const {
  if (!photometry->round) return position + (u - 0.5) * x + (v - 0.5) * y;
  const double r = 0.5 * std::sqrt(u), a = 2.0 * pi * v;
  return position + r * std::cos(a) * x + r * std::sin(a) * y;
}

Lamps place_lamps(const Scene& scene) {
  Lamps lamps;
  for (std::uint32_t e = 0; e < scene.lamps.size(); ++e) {
    const auto& entry = scene.lamps[e];
    for (const auto& placement : entry.placements) {
      lamps.units.push_back({e, {}, {}});
      if (entry.photometry)
        add_beam(entry, placement.map, lamps);
      else
        add_mesh_copy(entry, placement.map, lamps);
    }
  }
  for (std::uint32_t s = 0; s < scene.states.size(); ++s) {
    std::vector<bool> on(scene.lamps.size());
    for (std::size_t e = 0; e < on.size(); ++e) {
      const auto& states = scene.lamps[e].states;
      on[e] = states.empty() || std::find(states.begin(), states.end(), s) != states.end();
    }
    std::uint32_t row = Lamps::none;
    if (std::find(on.begin(), on.end(), true) != on.end()) {
      row = static_cast<std::uint32_t>(std::find(lamps.sets.begin(), lamps.sets.end(), on) - lamps.sets.begin());
      if (row == lamps.sets.size()) lamps.sets.push_back(on);
    }
    lamps.set_of_state.push_back(row);
  }
  return lamps;
}

std::vector<double> lamp_shares(const Lamps& lamps) {
  const auto& units = lamps.units;
  std::vector<double> total(units.empty() ? 0 : units.front().power.size(), 0.0), out;
  for (const auto& unit : units)
    for (std::size_t b = 0; b < total.size(); ++b) total[b] += unit.power[b];
  const auto share = [&](const std::vector<double>& strength, double times) {
    double sum = 0.0;
    for (std::size_t b = 0; b < total.size(); ++b)
      if (total[b] > 0.0) sum += times * strength[b] / total[b];
    out.push_back(sum);
  };
  for (const auto& face : lamps.faces) share(units[face.unit].exitance, face.area);
  for (const auto& beam : lamps.beams) share(units[beam.unit].power, 1.0);
  return out;
}

LampEmission::LampEmission(const Lamps& lamps) : lamps_(lamps) {
  cumulative_ = lamp_shares(lamps);
  std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
}

LampEmission::Particle LampEmission::draw(const double* x) const {
  const double at = x[0] * power();
  const auto i = std::min<std::size_t>(
      static_cast<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin()), cumulative_.size() - 1);
  const double share = (cumulative_[i] - (i > 0 ? cumulative_[i - 1] : 0.0)) / power();
  Particle out;
  if (i < lamps_.faces.size()) {
    const auto& face = lamps_.faces[i];
    out.unit = face.unit;
    const auto& unit = lamps_.units[face.unit];
    // the unit's power is spread over its faces: this one holds area x exitance of it
    std::size_t band = 0;
    while (band + 1 < unit.power.size() && unit.power[band] == 0.0) ++band;
    const double part = unit.power[band] > 0.0 ? face.area * unit.exitance[band] / unit.power[band] : 0.0;
    const double root = std::sqrt(x[1]);
    out.from =
        face.corners[0] + root * (1.0 - x[2]) * (face.corners[1] - face.corners[0]) + root * x[2] * (face.corners[2] - face.corners[0]);
    Vec3 u, v;
    orthonormal_frame(face.normal, u, v);
    const double r = std::sqrt(x[3]), a = 2.0 * pi * x[4];
    out.direction = r * std::cos(a) * u + r * std::sin(a) * v + std::sqrt(1.0 - x[3]) * face.normal;
    out.weight = part / share;
  } else {
    const auto& beam = lamps_.beams[i - lamps_.faces.size()];
    out.unit = beam.unit;
    out.from = beam.point(x[1], x[2]);
    const double z = 2.0 * x[3] - 1.0, r = std::sqrt(std::max(0.0, 1.0 - z * z)), a = 2.0 * pi * x[4];
    out.direction = {r * std::cos(a), r * std::sin(a), z};
    out.weight = 4.0 * pi * beam.photometry->intensity(beam.to_lamp * out.direction) / share;
  }
  return out;
}

}  // namespace sunfleck
