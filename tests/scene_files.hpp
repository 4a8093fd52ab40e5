// Scenes that a test writes for itself.
#pragma once

#include <map>
#include <string>

#include <format_files.hpp>
#include <sunfleck/format/scene_toml.hpp>

namespace sunfleck {

/// A folder with scene.toml and the files it names.
class SceneFiles {
 public:
  explicit SceneFiles(const std::string& scene, const std::map<std::string, std::string>& others = {}) : scene_("scene.toml", scene) {
    for (const auto& [name, content] : others) {
      const auto path = std::filesystem::path(scene_.folder()) / name;
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path, std::ios::binary) << content;
    }
  }
  Scene read() const { return read_scene(scene_.path); }
  SceneFile read_file() const { return read_scene_file(scene_.path); }
  /// The InputError of reading, with paths as seen from the folder; empty if there is none.
  std::string message() const {
    return message_of(scene_, [&] { read(); });
  }
  const TextFile& file() const { return scene_; }

 private:
  TextFile scene_;
};

/// Two organs, a and b, of two triangles each; a has material m.
inline const std::string two_organs =
    "g a\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
    "g b\nusemtl n\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 5 6 7\nf 5 7 8\n";

}  // namespace sunfleck
