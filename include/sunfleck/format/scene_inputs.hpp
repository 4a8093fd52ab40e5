// Which files a scene is made of, from its text alone: a result keeps that.
#pragma once

#include <string>

namespace sunfleck {

/// Adds `scene_file`, all files that `scene_text` names and that are there, and the material libraries of those that are .obj, to the
/// newest InputRecord. None of them is read but the first 64 KiB of an .obj. Text that is not TOML names nothing. Paths are relative to the
/// folder of `scene_file`.
void note_scene_inputs(const std::string& scene_text, const std::string& scene_file);

}  // namespace sunfleck
