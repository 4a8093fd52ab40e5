// `sunfleck import FILES -o SCENE.toml`: scenes of AMAP and CARIBU as scene files.
#include <fmt/format.h>

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/format/import_scene.hpp>
#include <sunfleck/format/scene_toml.hpp>
#include <sunfleck/scene/counts.hpp>

#include "cli/output_path.hpp"
#include "cli/text_units.hpp"

namespace sunfleck {

int verb_import(const ImportOptions& options, Progress& progress) {
  check_output_path(options.choice.output, {".toml"}, options.choice.files);
  const ImportedScene scene = import_scene(options.choice);
  progress.check();
  ReplacedFile out(options.choice.output);
  out.write(scene.text);
  out.commit();
  for (const auto& note : scene.notes) progress.line("note: " + note);
  const SceneCounts counts = count(read_scene(options.choice.output));  // what is written can be solved
  progress.line(fmt::format("wrote {}: {}, {} of plants", options.choice.output, counted(counts.organs, "organ", "organs"),
                            counted(counts.plant_facets, "facet", "facets")));
  return 0;
}

}  // namespace sunfleck
