// Writes a large result of made-up values, for measuring what reading it costs: `bench_large_result OUT.h5 [COPIES] [LEAVES]`.
// A plant of LEAVES leaves (two facets each, one mesh) stands COPIES times; values are a smooth function of place, the same on every
// machine. Then, for example: /usr/bin/time -v sunfleck export OUT.h5 -o out.ply
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/scene/build.hpp>

using namespace sunfleck;

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_large_result OUT.h5 [COPIES] [LEAVES]\n");
    return 2;
  }
  const auto number = [&](int i, long otherwise) { return static_cast<std::size_t>(argc > i ? std::atol(argv[i]) : otherwise); };
  const std::size_t copies = number(2, 100), leaves = number(3, 50000);

  auto plant = std::make_shared<Plant>(empty_plant("tree"));
  plant->materials = {""};
  plant->meshes.push_back({{{0, 0, 0}, {0.05, 0, 0}, {0.05, 0.03, 0}, {0, 0.03, 0.005}}, {{0, 1, 2}, {0, 2, 3}}});
  RandomStream random(1);
  for (std::size_t i = 0; i < leaves; ++i) {
    const auto leaf = add_structure(*plant, 0, "leaf", "");
    const Vec3 place{2 * random.next() - 1, 2 * random.next() - 1, 1 + 3 * random.next()};
    plant->shapes.push_back({leaf, 0, 0, 2, 0, Affine::translate(place) * Affine::turn(6.28 * random.next())});
  }
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units = {"W m^-2", "W m^-2"};
  LightState noon;
  noon.name = "noon";
  noon.duration_s = 3600;
  noon.sun = Sun{{0, 0, 1}, {400, 300}, 0.53};
  scene.states = {noon};
  scene.optics.push_back(uniform_optics("leaf", {0.1, 0.45}, {0.05, 0.4}));
  std::vector<Placement> places;
  for (std::size_t c = 0; c < copies; ++c)
    places.push_back(placed({.position = {3.0 * static_cast<double>(c % 100), 3.0 * static_cast<double>(c / 100), 0},
                             .turn_deg = 37.0 * static_cast<double>(c)}));
  PlantEntry entry{"tree", plant, std::vector<std::uint32_t>(leaves, 0), "", places};
  scene.plants.push_back(entry);

  const PlacedScene copies_in_world = place(scene);
  const PlantFacets own = plant_facets(scene.plants[0]);
  {
    ResultWriter writer(argv[1], scene, copies_in_world, OutputChoice{}, "bench", "flat");
    std::vector<float> irradiance(own.size() * 4), sunlit(own.size() * 2);
    for (const auto& copy : copies_in_world.copies) {
      for (std::size_t i = 0; i < own.size(); ++i) {
        const Vec3 p = copy.map.point(own.corners[i][0]);
        const auto light = static_cast<float>(100 + 50 * std::sin(p.x) + 80 * p.z);
        irradiance[4 * i] = light, irradiance[4 * i + 1] = 0.8f * light;
        irradiance[4 * i + 2] = 0.3f * light, irradiance[4 * i + 3] = 0.4f * light;
        sunlit[2 * i] = p.z > 2.5 ? 1.0f : 0.25f;
      }
      writer.rows({copy.first_facet, own.size(), irradiance.data(), sunlit.data(), nullptr});
    }
    SolveReport report;
    report.method = "flat";
    report.balance = {{{1, 1, 0, 0}, {1, 1, 0, 0}}};
    writer.finish(report);
  }
  std::printf("%zu facets, %zu organs, %zu copies; peak %.0f MiB\n", static_cast<std::size_t>(copies_in_world.facets),
              static_cast<std::size_t>(copies_in_world.organs), copies, static_cast<double>(peak_resident_bytes()) / 1048576.0);
  return 0;
}
