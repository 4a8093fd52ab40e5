// `sunfleck generate SPECIES.toml -o PLANT.h5`: a procedural plant as a hierarchy of structures.
#include <filesystem>

#include <fmt/format.h>

#include <cli/output_path.hpp>
#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/format/write_plant_obj.hpp>

namespace sunfleck {

int verb_generate(const GenerateOptions& options, Progress& progress) {
  check_output_path(options.output, {".h5", ".obj"}, {options.species});
  const Species species = read_species(options.species);
  prepare_outputs({options.output}, progress);
  const double age = options.age.value_or(species.age);
  const std::uint64_t seed = options.seed.value_or(species.seed);
  progress.line(fmt::format("growing {} to {} {}, seed {}", species.name, age, species.age_unit, seed));
  const Plant plant = grow(species, age, seed);
  progress.check();
  const std::string suffix = std::filesystem::path(options.output).extension().string();
  if (suffix == ".h5" || suffix == ".H5")
    write_plant_h5(plant, options.output);
  else
    write_plant_obj(plant, options.output);

  std::vector<bool> organ(plant.structures.size(), false);
  for (const auto& shape : plant.shapes) organ[shape.structure] = true;
  std::vector<std::size_t> per_type(plant.types.size(), 0);
  std::size_t organs = 0;
  for (std::size_t i = 0; i < plant.structures.size(); ++i) {
    ++per_type[plant.structures[i].type];
    organs += organ[i];
  }
  const LeafTotals leaves = leaf_totals(plant);
  fmt::print("{}: {} at {} {}, seed {}\n", options.output, species.name, age, species.age_unit, seed);
  fmt::print("  structures  {}\n", plant.structures.size());
  for (std::size_t t = 0; t < per_type.size(); ++t) fmt::print("    {:<12}{}\n", plant.types[t], per_type[t]);
  fmt::print("  organs      {}\n  facets      {}\n  meshes      {}\n", organs, plant.facet_count(), plant.meshes.size());
  fmt::print("  leaves      {}\n  leaf area   {:.4g} m2 (one-sided)\n  height      {:.3g} m\n", leaves.leaves, leaves.area_m2,
             plant.bounds().high.z);
  return 0;
}

}  // namespace sunfleck
