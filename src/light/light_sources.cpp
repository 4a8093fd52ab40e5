#include <sunfleck/light/light_sources.hpp>

namespace sunfleck {

LightSources light_sources(const std::vector<LightState>& states) {
  LightSources out;
  for (const auto& state : states) {
    std::uint32_t sky_row = LightSources::none, sun_row = LightSources::none;
    if (state.sky) {
      for (sky_row = 0; sky_row < out.skies.size() && !same_radiance(*out.skies[sky_row], *state.sky); ++sky_row) {
      }
      if (sky_row == out.skies.size()) out.skies.push_back(&*state.sky);
    }
    if (state.sun) {
      const auto same = [&](const Sun& sun) {
        return sun.direction == state.sun->direction && sun.angular_diameter_deg == state.sun->angular_diameter_deg;
      };
      for (sun_row = 0; sun_row < out.suns.size() && !same(*out.suns[sun_row]); ++sun_row) {
      }
      if (sun_row == out.suns.size()) out.suns.push_back(&*state.sun);
    }
    out.sky_of_state.push_back(sky_row);
    out.sun_of_state.push_back(sun_row);
  }
  return out;
}

}  // namespace sunfleck
