// Scene files: TOML as docs/formats-scene.md describes it.
#pragma once

#include <string>

#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// What a scene file says: the scene, and how it would like to be solved and kept ([solve], [output]).
struct SceneFile {
  Scene scene;
  RunSettings run;
  OutputChoice output;
};

/// Reads a scene and all it names. Throws InputError with file, line and key; all unknown keys at once, each with the nearest known one.
SceneFile read_scene_file(const std::string& file);
/// The scene alone.
Scene read_scene(const std::string& file);

}  // namespace sunfleck
