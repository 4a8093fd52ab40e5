// A canopy without end: a cell of leaves that repeats in x and y, over ground. What is absorbed and what leaves adds up to what comes.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace sunfleck;
  std::vector<Mesh> leaves;  // 200 of .01 m^2 over 1 m^2: leaf area index 2.3, sloping
  for (int i = 0; i < 200; ++i) {
    const double x = std::fmod(0.754877666 * i, 1.0), y = std::fmod(0.569840291 * i, 1.0), z = 0.1 + 0.9 * std::fmod(0.618033989 * i, 1.0);
    const double h = 0.05, slope = i % 2 ? 0.6 : -0.6;
    leaves.push_back(
        {{{x - h, y - h, z - h * slope}, {x + h, y - h, z + h * slope}, {x + h, y + h, z + h * slope}, {x - h, y + h, z - h * slope}},
         {{0, 1, 2}, {0, 2, 3}}});
  }
  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.1})};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, {0.2});
  scene.plants = {plant_entry("canopy", make_plant(leaves, "canopy", "leaf"), 0, {Placement{}})};
  LightState sky;
  sky.sky.emplace().irradiance = {100};  // of a uniform sky, on a horizontal plane
  scene.states = {sky};

  RunSettings run;
  run.quality = Quality::draft;
  const Solution light = solve(scene, run);
  double canopy = 0, ground = 0;
  for (std::size_t i = 0; i < light.organs.count; ++i)
    (light.organs.plant[i] == of_ground ? ground : canopy) += light.organs.absorbed_in(i);
  std::printf("of 100 W m^-2: canopy %.1f, ground %.1f, reflected %.1f\n", canopy, ground, 100 - canopy - ground);
  return canopy > 78 && canopy < 87 && ground > 8 && ground < 15 && canopy + ground < 98 ? 0 : 1;
}
