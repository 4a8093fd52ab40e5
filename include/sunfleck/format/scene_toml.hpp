// Scene files: TOML as docs/formats-scene.md describes it.
#pragma once

#include <string>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Reads a scene and all it names. Throws InputError with file, line and key; all unknown keys at once, each with the nearest known one.
Scene read_scene(const std::string& file);

}  // namespace sunfleck
