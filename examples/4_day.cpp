// A day: the sun at every hour of a place and date, one solve for all of them, and what the leaf absorbed in sum.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace sunfleck;
  const Mesh leaf{{{0, 0, 1}, {0.1, 0, 1}, {0.1, 0.1, 1}, {0, 0.1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.1})};
  scene.plants = {plant_entry("leaf", make_plant(leaf, "leaf", "leaf"), 0, {Placement{}})};
  double direct = 0;  // on a horizontal plane [J m^-2]
  for (int hour = 4; hour < 21; ++hour) {
    char time[32];
    std::snprintf(time, sizeof time, "2026-06-21T%02d:30:00+01:00", hour);
    const SolarPosition at = solar_position(time, 48.1, 11.6, 500, "day");  // latitude, longitude [degrees], altitude [m]
    if (at.elevation_deg <= 0) continue;
    LightState state;
    state.name = time;
    state.duration_s = 3600;
    state.sun = Sun{.direction = direction_from_angles(at.elevation_deg, at.azimuth_deg), .irradiance = {400}};
    direct += 3600 * 400 * state.sun->direction.z;
    scene.states.push_back(state);
  }

  const Solution light = solve(scene);
  double absorbed = 0;
  for (std::size_t s = 0; s < light.organs.states; ++s) {
    std::printf("%s  %.3f W\n", scene.states[s].name.c_str(), light.organs.absorbed_in(0, 0, s));
    absorbed += scene.states[s].duration_s * light.organs.absorbed_in(0, 0, s);
  }
  std::printf("in sum %.0f J\n", absorbed);
  return std::abs(absorbed - 0.8 * 0.01 * direct) < 5e-3 * absorbed ? 0 : 1;  // .8 of what falls on .01 m^2
}
