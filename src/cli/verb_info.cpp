// `sunfleck info FILE`: what a result, plant, species or scene file holds.
#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/plant/describe.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/plant_sizes.hpp>

#include "cli/info_result.hpp"
#include "cli/json_text.hpp"
#include "cli/sizes_text.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const PlantSummary& p) {
  Json json{{"file", p.file},
            {"kind", "plant"},
            {"name", p.name},
            {"structures", p.structures},
            {"organs", p.organs},
            {"facets", p.facets},
            {"zero_area_facets", p.zero_area_facets},
            {"area_m2", p.area_m2},
            {"meshes", p.meshes},
            {"shapes", p.shapes},
            {"materials", p.materials},
            {"attributes", p.attributes}};
  for (const auto& t : p.types)
    json["types"][t.type] = {{"structures", t.structures}, {"organs", t.organs}, {"facets", t.facets}, {"area_m2", t.area_m2}};
  if (!p.bounds.empty())
    json["bounds_m"] = {{p.bounds.low.x, p.bounds.low.y, p.bounds.low.z}, {p.bounds.high.x, p.bounds.high.y, p.bounds.high.z}};
  json["notes"] = p.notes;
  return json;
}

void plant_info(const Plant& plant, bool json) {
  const auto summary = summarize_plant(plant);
  fmt::print("{}{}", json ? json_text(json_of(summary)) : describe_plant(summary), json ? "\n" : "");
}

void species_info(const std::string& file, bool json) {
  const Species species = read_species(file);
  const auto summary = summarize_plant(read_species_plant(file));
  if (json) {
    Json out{{"file", file},        {"kind", "species"}, {"name", species.name}, {"age", species.age}, {"age_unit", species.age_unit},
             {"seed", species.seed}};
    out["plant"] = json_of(summary);
    fmt::print("{}\n", json_text(out));
    return;
  }
  fmt::print("species    {} ({})\ngrown to   {} {}, seed {}\n{}", species.name, file, species.age, species.age_unit, species.seed,
             describe_plant(summary));
}

void scene_info(const std::string& file, bool json) {
  const Scene scene = read_scene(file);
  const SceneCounts counts = count(scene);
  const SceneSizes sizes = scene_sizes(scene);
  if (json) {
    Json out{{"file", file},
             {"kind", "scene"},
             {"bands", scene.bands},
             {"plant_facets", counts.plant_facets},
             {"ground_facets", counts.ground_facets},
             {"organs", counts.organs}};
    for (const auto& state : scene.states) out["states"].push_back(state.name);
    for (std::size_t p = 0; p < scene.plants.size(); ++p)
      out["plants"].push_back({{"name", scene.plants[p].name},
                               {"file", scene.plants[p].plant->file},
                               {"facets", scene.plants[p].plant->facet_count()},
                               {"copies", counts.copies[p]},
                               {"height_m", sizes.plants[p].height},
                               {"width_m", sizes.plants[p].width},
                               {"lowest_m", sizes.plants[p].lowest}});
    if (const Box& box = sizes.all; !box.empty())
      out["bounds_m"] = {{box.low.x, box.low.y, box.low.z}, {box.high.x, box.high.y, box.high.z}};
    if (scene.periodic) out["periodic"] = {scene.periodic->x_low, scene.periodic->y_low, scene.periodic->x_high, scene.periodic->y_high};
    out["notes"] = scene.notes;
    fmt::print("{}\n", json_text(out));
    return;
  }
  fmt::print("scene      {}\nbands      {}\nstates     {}\n", file, fmt::join(scene.bands, ", "), scene.states.size());
  if (scene.periodic) fmt::print("repeats    every {:g} x {:g} m\n", scene.periodic->width(), scene.periodic->depth());
  for (std::size_t p = 0; p < scene.plants.size(); ++p)
    fmt::print("{:<11}{}: {} x {}, {} ({})\n", p == 0 ? "plants" : "", scene.plants[p].name,
               copies_text(counts.copies[p]) + (counts.copies[p] == 1 ? " copy" : " copies"),
               counted(scene.plants[p].plant->facet_count(), "facet", "facets"),
               sizes.plants[p].placed ? size_text(sizes.plants[p]) : "not placed", scene.plants[p].plant->file);
  if (const Box& box = sizes.all; !box.empty())
    fmt::print("extent     x {:.4g} .. {:.4g}, y {:.4g} .. {:.4g}, z {:.4g} .. {:.4g} m\n", box.low.x, box.high.x, box.low.y, box.high.y,
               box.low.z, box.high.z);
  fmt::print("facets     {} of plants, {} of the ground\norgans     {}\n", counts.plant_facets, counts.ground_facets, counts.organs);
  for (const auto& note : scene.notes) fmt::print("note       {}\n", note);
}

}  // namespace

int verb_info(const InfoOptions& options, Progress&) {
  std::string suffix = std::filesystem::path(options.file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".toml" && is_species(options.file))
    species_info(options.file, options.json);
  else if (suffix == ".toml")
    scene_info(options.file, options.json);
  else if (is_result(options.file) || suffix == ".hdf5")
    print_result_info(options.file, options.json);
  else
    plant_info(read_plant(options.file), options.json);
  return 0;
}

}  // namespace sunfleck
