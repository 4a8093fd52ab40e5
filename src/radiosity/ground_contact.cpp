#include "ground_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr std::uint64_t contact_stream = 0x3c6ef372fe94f82bULL;

/// Is the ground below everything else?
bool plants_stand_off(const Elements& e, double reach) {
  const auto& s = e.surface;
  float top = -std::numeric_limits<float>::infinity(), lowest = std::numeric_limits<float>::infinity();
  for (std::size_t t = 0; t < s.size(); ++t) {
    if (s.split[t] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const float z = s.corner[3 * k + 2][t];
      if (e.order[t] >= e.plant_facets)
        top = std::max(top, z);
      else
        lowest = std::min(lowest, z);
    }
  }
  return !(lowest - top <= reach);
}

}  // namespace

GroundContact::GroundContact(const Elements& e, double pitch, std::uint64_t seed) {
  reach_ = std::max(1.5 * e.surface.ground_gap, 2e-3 * std::sqrt(e.element_area));
  if (!(e.surface.ground_gap > 0.0) || plants_stand_off(e, reach_)) return;
  elements_ = &e;
  LineBundle bundle;
  const Vec3 up{0.0, 0.0, 1.0};
  trace_lines(e.surface, project_set_member(e.surface, up, 0, pitch, mix(seed, contact_stream)), bundle, LinesKept::met);
  bool found = false;
  for (std::size_t q = 0; q + 1 < bundle.start.size() && !found; ++q)
    each_covered(bundle, up, bundle.start[q], bundle.start[q + 1], [&](std::uint32_t) { found = true; });
  if (!found) elements_ = nullptr;
}

}  // namespace sunfleck
