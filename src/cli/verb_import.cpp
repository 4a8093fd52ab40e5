// `sunfleck import FILES -o SCENE.toml`: scenes of AMAP and CARIBU as scene files.
#include <filesystem>

#include <fmt/format.h>

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/core/sha256.hpp>
#include <sunfleck/format/import_scene.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/scene/counts.hpp>

#include "cli/output_path.hpp"
#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

/// First line of an imported scene: the checksum of what follows tells whether it has been worked on since.
std::string mark_of(const std::string& text) {
  return "# Written by sunfleck import, sha256 of what follows " + sha256_hex(text) + "\n";
}

/// A scene that is there already may be replaced if it's as import wrote it: one written or changed by hand is the only one of its kind.
void check_is_imported(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  const InputRecord aside;  // looked at; what it is replaced by is no input of itself
  const std::string there = read_input_file(file);
  const std::size_t end = there.find('\n');
  if (end != std::string::npos && there.substr(0, end + 1) == mark_of(there.substr(end + 1))) return;
  throw UsageError(
      fmt::format("{}: found a scene that import has not written, or that was changed since; expected another name to write to", file));
}

}  // namespace

int verb_import(const ImportOptions& options, Progress& progress) {
  check_output_path(options.choice.output, {".toml"}, options.choice.files);
  check_is_imported(options.choice.output);
  const ImportedScene scene = import_scene(options.choice);
  prepare_outputs({options.choice.output}, progress);
  progress.check();
  ReplacedFile out(options.choice.output);
  out.write(mark_of(scene.text) + scene.text);
  out.commit();
  for (const auto& note : scene.notes) progress.line("note: " + note);
  const SceneCounts counts = count(read_scene(options.choice.output));  // what is written can be solved
  progress.line(fmt::format("wrote {}: {}, {} of plants", options.choice.output, counted(counts.organs, "organ", "organs"),
                            counted(counts.plant_facets, "facet", "facets")));
  return 0;
}

}  // namespace sunfleck
