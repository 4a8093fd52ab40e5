#include "cli/result_inputs.hpp"

#include <filesystem>

#include <sunfleck/format/scene_inputs.hpp>

namespace sunfleck {

void note_inputs_of(const Result& result) {
  namespace fs = std::filesystem;
  const auto& header = result.header();
  if (header.scene_file.empty()) return;
  const fs::path scene(header.scene_file), folder = fs::path(result.file()).parent_path();
  note_scene_inputs(header.scene_text, scene.string());
  for (const fs::path& other : {folder / scene, folder / scene.filename()}) {
    std::error_code error;
    if (fs::is_regular_file(other, error)) note_scene_inputs(header.scene_text, other.string());
  }
}

}  // namespace sunfleck
