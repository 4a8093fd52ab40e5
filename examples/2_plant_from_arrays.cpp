// A plant from arrays, as growth models have it: corners of triangles, and the organ that each belongs to.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace sunfleck;
  // Eight leaves up a stem, each a rhomb of two triangles, turned by 137.5 degrees from one to the next.
  std::vector<double> corners;        // 9 numbers a triangle
  std::vector<std::uint32_t> organs;  // one a triangle
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double a = 137.5 / 180 * 3.14159265358979 * i, c = std::cos(a), s = std::sin(a), z = 0.1 * (i + 1);
    const double tip[3]{0.2 * c, 0.2 * s, z}, left[3]{0.1 * c - 0.04 * s, 0.1 * s + 0.04 * c, z},
        right[3]{0.1 * c + 0.04 * s, 0.1 * s - 0.04 * c, z};
    const double base[3]{0, 0, z};
    for (const double* p : {base, right, tip, base, tip, left}) corners.insert(corners.end(), p, p + 3);
    organs.insert(organs.end(), 2, i);
  }

  Plant plant = empty_plant("herb");
  std::vector<std::uint32_t> owner(organs.size());
  for (std::uint32_t i = 0; i < 8; ++i) {
    const auto leaf = add_structure(plant, 0, "leaf", "leaf_" + std::to_string(i + 1));
    for (std::size_t t = 0; t < organs.size(); ++t)
      if (organs[t] == i) owner[t] = leaf;
  }
  Mesh mesh;
  for (std::size_t v = 0; v + 2 < corners.size(); v += 3) mesh.vertices.push_back({corners[v], corners[v + 1], corners[v + 2]});
  for (std::uint32_t t = 0; t < organs.size(); ++t) mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  add_mesh(plant, mesh, owner, std::vector<std::uint32_t>(organs.size(), plant.material_index("")));

  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units = {"W m^-2", "W m^-2"};
  scene.optics = {uniform_optics("leaf", {0.08, 0.45}, {0.05, 0.45})};
  scene.plants = {plant_entry("herb", plant, 0, {Placement{}})};
  LightState overcast;
  overcast.sky.emplace().model = SkyModel::standard_overcast;
  overcast.sky->irradiance = {200, 200};
  scene.states = {overcast};

  const Solution light = solve(scene);
  const OrganViews views = organ_views(scene);
  for (std::size_t i = 0; i < light.organs.count; ++i)
    std::printf("%-7s PAR %.4f W  NIR %.4f W  sees %.2f of the sky\n", light.organs.name(i).c_str(), light.organs.absorbed_in(i, 0),
                light.organs.absorbed_in(i, 1), views.sky[2 * i]);
  return light.organs.count == 8 && light.organs.absorbed_in(7) > 1.05 * light.organs.absorbed_in(0) ? 0 : 1;  // the top has most
}
