// Copies of one plant, each turned in its own way, and a policy: which structures stand in for each other.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  using namespace sunfleck;
  std::vector<Mesh> leaves;
  for (int i = 0; i < 30; ++i) {
    const double a = 2.4 * i, x = 0.12 * std::cos(a), y = 0.12 * std::sin(a), z = 0.02 * i + 0.1, h = 0.04;
    leaves.push_back({{{x - h, y - h, z}, {x + h, y - h, z}, {x + h, y + h, z + 0.02}, {x - h, y + h, z + 0.02}}, {{0, 1, 2}, {0, 2, 3}}});
  }
  std::vector<Placement> stand;
  for (int i = 0; i < 36; ++i)
    stand.push_back(placed({.position = {0.4 * (i % 6), 0.4 * (i / 6), 0}, .turn_deg = 137.5 * i, .scale = 1 + 0.01 * (i % 5)}));

  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.1})};
  scene.plants = {plant_entry("herb", make_plant(leaves, "herb", "leaf"), 0, stand)};
  if (argc > 1) scene.plants[0].policy_file = argv[1];  // share/sunfleck/policies/generic.toml of the install tree
  scene.ground = flat_ground({3, 3}, {1, 1}, {6, 6}, {0.2});
  LightState sky;
  sky.sky.emplace().irradiance = {100};  // of a uniform sky, on a horizontal plane
  scene.states = {sky};

  RunSettings run;
  run.quality = Quality::draft;
  run.method = "instantiation";  // each plant once, its copies through it
  const Solution light = solve(scene, run);
  std::vector<double> of_copy(stand.size(), 0);
  for (std::size_t i = 0; i < light.organs.count; ++i)
    if (light.organs.plant[i] != of_ground) of_copy[light.organs.copy[i]] += light.organs.absorbed_in(i);
  std::printf("%s at the corner absorbs %.2f W, one in the middle %.2f W\n", light.organs.placement(0).c_str(), of_copy[0], of_copy[14]);
  return light.organs.count == 30 * 36 + 36 && of_copy[0] > of_copy[14] && of_copy[14] > 0 ? 0 : 1;
}
