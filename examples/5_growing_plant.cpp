// A growing plant: in each step every leaf grows by the light that it absorbs, and a session keeps what did not change.
#include <sunfleck/sunfleck.hpp>

#include <cmath>
#include <cstdio>

int main() {
  using namespace sunfleck;
  std::vector<double> length(6, 0.05);  // of the leaves, the lowest first [m]
  const auto grown = [&] {
    std::vector<Mesh> leaves;
    for (std::size_t i = 0; i < length.size(); ++i) {
      const double l = length[i], w = 0.3 * l, z = 0.05 * static_cast<double>(i + 1);
      leaves.push_back({{{0, -w, z}, {l, -w, z}, {l, w, z}, {0, w, z}}, {{0, 1, 2}, {0, 2, 3}}});
    }
    return make_plant(leaves, "plant", "leaf");
  };
  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.05})};
  LightState sky;
  sky.sky.emplace().model = SkyModel::standard_overcast;
  sky.sky->irradiance = {300};
  scene.states = {sky};

  RunSettings run;
  run.quality = Quality::draft;
  run.certificate = false;
  Session session(run);
  for (int step = 1; step <= 5; ++step) {
    scene.plants = {plant_entry("plant", grown(), 0, {Placement{}})};
    const Solution light = session.solve(scene);
    double all = 0;
    for (std::size_t i = 0; i < length.size(); ++i) {
      const double per_area = light.organs.absorbed_in(i) / light.organs.area[i];  // [W m^-2]
      length[i] *= 1 + 0.001 * per_area;
      all += light.organs.absorbed_in(i);
    }
    std::printf("step %d: %.3f W; leaves of", step, all);
    for (double l : length) std::printf(" %.3f", l);
    std::printf(" m\n");
  }
  return length.back() > 1.25 * length.front() && std::isfinite(length.front()) ? 0 : 1;  // those in the shade stay behind
}
