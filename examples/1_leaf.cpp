// A leaf of two triangles under a uniform sky and the sun overhead: what it absorbs.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace sunfleck;
  Mesh leaf;  // .1 m x .05 m, its front upwards [m]
  leaf.vertices = {{0, 0, 1}, {0.1, 0, 1}, {0.1, 0.05, 1}, {0, 0.05, 1}};
  leaf.triangles = {{0, 1, 2}, {0, 2, 3}};

  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.1})};  // reflects and transmits a tenth
  scene.plants = {plant_entry("leaf", make_plant(leaf, "leaf", "leaf"), 0, {Placement{}})};
  LightState noon;
  noon.sky.emplace().irradiance = {100};  // of a uniform sky, on a horizontal plane
  noon.sun = Sun{.direction = {0, 0, 1}, .irradiance = {400}};
  scene.states = {noon};

  const Solution light = solve(scene);
  const double area = light.organs.area[0], absorbed = light.organs.absorbed_in(0);
  std::printf("%s: %.4f m^2, irradiance from above %.1f W m^-2, absorbed %.4f W\n", light.organs.name(0).c_str(), area,
              light.organs.irradiance_on(0, 0), absorbed);
  // nothing shades it: .8 x 500 W m^-2 x .005 m^2
  return std::abs(absorbed - 0.8 * 500 * 0.005) < 1e-3 * absorbed ? 0 : 1;
}
