// Writes a result of 1,000 copies of one tree of 10^5 facets (2 facets an organ) from rows that are made up: seconds and memory of the
// writer alone. Arguments: file, copies (1000), facets of a tree (100000), "facets" or "organs" (organs), "constant" or "noise" (noise).
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/result/result_writer.hpp>
#include <sunfleck/scene/build.hpp>

using namespace sunfleck;

namespace {

Scene forest(std::size_t copies, std::size_t facets) {
  auto plant = std::make_shared<Plant>();
  const auto root = plant->type_index("Plant"), leaf = plant->type_index("Leaf");
  plant->materials = {""};
  plant->structures.push_back({no_parent, root, "tree", {}, {}});
  plant->meshes.push_back({{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.05, 0}, {0, 0.05, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  RandomStream random(1);
  for (std::uint32_t i = 0; i < facets / 2; ++i) {
    plant->structures.push_back({0, leaf, "", {}, {}});
    plant->shapes.push_back(
        {i + 1, 0, 0, 2, 0,
         Affine::translate({random.next() * 4, random.next() * 4, 1 + random.next() * 8}) * Affine::turn(6.28 * random.next())});
  }
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units = {"W m^-2", "W m^-2"};
  scene.optics.push_back(uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.4}));
  scene.states.resize(1);
  PlantEntry entry{"tree", plant, std::vector<std::uint32_t>(plant->shapes.size(), 0), "", {}};
  for (std::size_t i = 0; i < copies; ++i)
    entry.placements.push_back({Affine::translate({5.0 * static_cast<double>(i % 32), 5.0 * static_cast<double>(i / 32), 0}) *
                                Affine::turn(0.1 * static_cast<double>(i))});
  scene.plants.push_back(entry);
  scene.ground = flat_ground({160, 160}, {80, 80}, {100, 100}, {0.1, 0.2});
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i, const char* otherwise) { return std::string(argc > i ? argv[i] : otherwise); };
  const std::size_t copies = std::strtoull(argument(2, "1000").c_str(), nullptr, 10);
  const std::size_t facets = std::strtoull(argument(3, "100000").c_str(), nullptr, 10);
  const bool keep_facets = argument(4, "organs") == "facets", noise = argument(5, "noise") == "noise";
  const Scene scene = forest(copies, facets);
  const std::size_t before = peak_resident_bytes();
  const Stopwatch watch;
  const PlacedScene placed = place(scene);
  ResultWriter writer(argument(1, "forest.h5"), scene, placed, {keep_facets, {}}, "bench", "none");
  std::printf("prepared %.1f s\n", watch.seconds());
  constexpr std::size_t rows = 100000;
  std::vector<float> irradiance(rows * 4, 100.0f), sunlit(rows * 2, 0.5f);
  RandomStream random(2);
  if (noise)
    for (auto* values : {&irradiance, &sunlit})
      for (auto& x : *values) x *= static_cast<float>(random.next());
  for (std::uint64_t first = 0; first < placed.facets; first += rows)
    writer.rows({first, std::min<std::uint64_t>(rows, placed.facets - first), irradiance.data(), sunlit.data(), nullptr});
  std::printf("rows     %.1f s\n", watch.seconds());
  SolveReport report;
  report.balance.assign(1, std::vector<Balance>(2));
  writer.finish(report);
  std::printf("finished %.1f s: %llu facets, %llu organs; peak %.1f MiB, of which scene %.1f MiB\n", watch.seconds(),
              static_cast<unsigned long long>(placed.facets), static_cast<unsigned long long>(placed.organs),
              static_cast<double>(peak_resident_bytes()) / 1048576.0, static_cast<double>(before) / 1048576.0);
}
