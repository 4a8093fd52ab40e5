// Error and CPU seconds of a method over fineness, against a reference: what the curves of `solve --error` (cli/refinement.cpp) come from.
//   build/tests/bin/bench_error_over_fineness SCENE.toml REFERENCE.h5 METHOD SEEDS FINENESS...
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <unistd.h>

#include <sunfleck/core/version.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/instantiation/fineness.hpp>
#include <sunfleck/radiosity/fineness.hpp>
#include <sunfleck/result/compare.hpp>
#include <sunfleck/result/result_writer.hpp>

using namespace sunfleck;

int main(int count, char** arguments) {
  if (count < 6) {
    fmt::print(stderr, "usage: bench_error_over_fineness SCENE.toml REFERENCE.h5 METHOD SEEDS FINENESS...\n");
    return 2;
  }
  const Scene scene = read_scene(arguments[1]);
  const Result reference(arguments[2]);
  const std::string method = arguments[3];
  const int seeds = std::stoi(arguments[4]);
  const PlacedScene placed = place(scene);
  const FacetScene facets = expand(scene);
  const auto file = std::filesystem::temp_directory_path() / fmt::format("error_over_fineness-{}.h5", getpid());
  for (int k = 5; k < count; ++k) {
    const double fineness = std::stod(arguments[k]);
    std::map<std::string, double> square;
    double seconds = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto start = std::clock();
      ResultWriter writer(file, scene, placed, OutputChoice{}, software_version(), method);
      SolveReport report;
      if (method == "instantiation") {
        InstantiationSettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.threads = 1;
        settings.density = instantiation_density_at(fineness);
        report = solve_instantiation(scene, placed, settings, writer, silent());
      } else {
        RadiositySettings settings;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.threads = 1;
        settings.density = density_at(fineness);
        settings.method = method == "flat" ? RadiosityMethod::flat : RadiosityMethod::clustering;
        report = solve_radiosity(scene, facets, settings, writer, silent());
      }
      writer.finish(report);
      seconds += double(std::clock() - start) / CLOCKS_PER_SEC / seeds;
      const auto errors = compare(Result(file), reference).organs.overall;
      for (std::size_t b = 0; b < errors.size(); ++b) square[scene.bands[b]] += errors[b].rmse * errors[b].rmse / seeds;
    }
    fmt::print("fineness {:.2f}: {:.2f} CPU s", fineness, seconds);
    for (const auto& [band, value] : square) fmt::print(", {} {:.3f} %", band, 100 * std::sqrt(value));
    fmt::print("\n");
    std::fflush(stdout);
  }
  std::filesystem::remove(file);
  return 0;
}
