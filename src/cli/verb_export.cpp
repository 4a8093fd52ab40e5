#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/output_path.hpp"

namespace sunfleck {

namespace {

const std::vector<std::string> suffixes{".ply", ".obj", ".glb", ".vtkhdf", ".xdmf", ".csv"};

}  // namespace

int verb_export(const ExportOptions& options, Progress& progress) {
  check_output_path(options.output, suffixes, {options.result});
  const Result result(options.result);
  std::string suffix = std::filesystem::path(options.output).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".csv") {
    if (options.quantity || options.band || options.state)
      throw UsageError("--quantity, --band, --state: a table holds them all; they belong to meshes");
    export_csv(result, options.output, progress);
    progress.line(fmt::format("wrote {}: {} organs", options.output, result.organ_count()));
    return 0;
  }
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
