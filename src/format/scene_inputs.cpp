#include <sunfleck/format/scene_inputs.hpp>

#include <filesystem>
#include <fstream>

#include <format/text.hpp>
#include <format/toml_value.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>

namespace sunfleck {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t head_bytes = std::size_t{64} << 10;  // material libraries are named at the beginning

void note_material_libraries(const fs::path& obj) {
  std::string head(head_bytes, '\0');
  std::ifstream in(obj, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  Lines lines(head);
  for (std::string_view line; lines.next(line);) {
    Words words(line);
    if (words.next() != "mtllib") continue;
    for (auto name = words.next(); !name.empty(); name = words.next()) InputRecord::note((obj.parent_path() / name).string());
  }
}

void note_texts(const TomlValue& value, const fs::path& folder) {
  if (value.is_table()) {
    for (const auto& [key, below] : value.members()) note_texts(below, folder);
  } else if (value.is_array()) {
    for (const auto& item : value.items()) note_texts(item, folder);
  } else if (value.is_text()) {
    const fs::path path = folder / value.text();
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return;  // most texts are none
    InputRecord::note(path.string());
    const std::string suffix = path.extension().string();
    if (suffix == ".obj" || suffix == ".OBJ") note_material_libraries(path);
  }
}

}  // namespace

void note_scene_inputs(const std::string& scene_text, const std::string& scene_file) {
  InputRecord::note(scene_file);
  try {
    const TomlDocument document(scene_text, scene_file);
    note_texts(document.root(), fs::path(scene_file).parent_path());
  } catch (const InputError&) {
  }
}

}  // namespace sunfleck
