#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/view/export.hpp>

#include "cli/output_path.hpp"

namespace sunfleck {

namespace {

const std::vector<std::string> suffixes{".ply", ".csv"};

std::size_t row_of(const std::string& option, const std::string& name, const std::vector<std::string>& names) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  const std::string nearest = nearest_name(name, names);
  throw UsageError(fmt::format("{}: found '{}'; expected one of {}{}", option, name, joined(names), nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

}  // namespace

int verb_export(const ExportOptions& options, Progress& progress) {
  check_output_path(options.output, suffixes, {options.result});
  const Result result(options.result);
  std::string suffix = std::filesystem::path(options.output).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".csv") {
    if (options.quantity || options.band || options.state) throw UsageError("--quantity, --band, --state: a table holds them all; they belong to meshes");
    export_csv(result, options.output, progress);
    progress.line(fmt::format("wrote {}: {} organs", options.output, result.organ_count()));
    return 0;
  }
  MeshChoice choice;
  if (options.quantity) choice.quantity = *options.quantity;
  if (options.band)
    choice.band = row_of("--band", *options.band, result.bands());
  else if (const auto par = std::find(result.bands().begin(), result.bands().end(), "PAR"); par != result.bands().end())
    choice.band = static_cast<std::size_t>(par - result.bands().begin());
  if (options.state) {
    std::vector<std::string> names;
    for (const auto& s : result.states()) names.push_back(s.name);
    choice.state = row_of("--state", *options.state, names);
  }
  export_ply(result, options.output, choice, progress);
  progress.line(fmt::format("wrote {}: {} facets", options.output, result.facet_count()));
  return 0;
}

}  // namespace sunfleck
