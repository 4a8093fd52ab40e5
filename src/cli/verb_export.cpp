#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/format/write_opf.hpp>
#include <sunfleck/view/copy_values.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/output_path.hpp"
#include "cli/result_inputs.hpp"
#include "cli/result_status.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

const std::vector<std::string> suffixes{".ply", ".obj", ".glb", ".vtkhdf", ".xdmf", ".csv", ".opf"};

/// One copy of a plant, with the light on its organs as attributes.
void export_opf(const Result& result, const ExportOptions& options, Progress& progress) {
  const ResultGeometry geometry = result.geometry();
  CopyValues copy = copy_values(result, geometry, options.copy, progress);
  const auto& entry = geometry.plants[copy.plant];
  const StructureColumns columns{std::move(copy.names), std::move(copy.values)};
  if (options.original) {
    add_to_opf(*options.original, columns, entry.plant->structures.size(), options.output);
  } else {
    Plant plant = *entry.plant;
    plant.file = result.file();
    for (std::size_t s = 0; s < plant.structures.size(); ++s) plant.structures[s].name = copy.organ_names[s];  // results keep those alone
    plant.materials.clear();
    for (const auto& material : result.materials()) plant.materials.push_back(material.name);
    for (std::size_t s = 0; s < plant.shapes.size(); ++s) plant.shapes[s].material = entry.shape_optics[s];
    write_opf(plant, columns, options.output);
  }
  progress.line(
      fmt::format("wrote {}: {}, {}", options.output, copy.placement, counted(entry.plant->structures.size(), "structure", "structures")));
}

}  // namespace

int verb_export(const ExportOptions& options, Progress& progress) {
  std::vector<std::string> inputs{options.result};
  if (options.original) inputs.push_back(*options.original);
  check_output_path(options.output, suffixes, inputs);
  const Result result(options.result);
  note_inputs_of(result);
  prepare_outputs({options.output}, progress);
  say_status(result, progress);
  std::string suffix = std::filesystem::path(options.output).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".csv") {
    if (options.copy || options.original) throw UsageError("--copy, --original: found without an .opf to write");
    if (options.quantity || options.band || options.state)
      throw UsageError("--quantity, --band, --state: a table holds them all; they belong to meshes");
    if (!options.sensors.empty()) {
      if (options.by) throw UsageError("--by: found with --sensor; it sums organs");
      const bool all = options.sensors == std::vector<std::string>{"all"};
      const auto rows = export_sensors(result, options.output, all ? std::vector<std::string>{} : options.sensors, progress);
      progress.line(fmt::format("wrote {}: {} of sensors", options.output, counted(rows, "cell", "cells")));
      return 0;
    }
    if (options.by)
      export_groups(result, options.output, *options.by, progress);
    else
      export_csv(result, options.output, progress);
    progress.line(options.by ? fmt::format("wrote {}: by {}", options.output, *options.by)
                             : fmt::format("wrote {}: {} organs", options.output, result.organ_count()));
    return 0;
  }
  if (!options.sensors.empty()) throw UsageError("--sensor: found without a table (.csv) to write");
  if (suffix != ".opf" && (options.copy || options.original)) throw UsageError("--copy, --original: found without an .opf to write");
  if (suffix == ".opf") {
    if (options.quantity || options.band || options.state || options.by)
      throw UsageError("--quantity, --band, --state, --by: an .opf holds every number of its organs; they belong to meshes and tables");
    export_opf(result, options, progress);
    return 0;
  }
  if (options.by) throw UsageError("--by: found with a mesh; it belongs to tables (.csv)");
  MeshChoice choice;
  if (options.quantity) choice.quantity = *options.quantity;
  choice.band = band_row(result, options.band);
  if (options.state) choice.state = state_row(result, options.state);
  static const std::map<std::string, decltype(&export_ply)> meshes{
      {".ply", export_ply}, {".obj", export_obj}, {".glb", export_glb}, {".vtkhdf", export_vtkhdf}, {".xdmf", export_xdmf}};
  meshes.at(suffix)(result, options.output, choice, progress);
  progress.line(fmt::format("wrote {}: {} facets", options.output, result.facet_count()));
  return 0;
}

}  // namespace sunfleck
