// Scenes of other programs as scene files of ours (docs/formats-import.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sunfleck {

struct ImportChoice {
  std::vector<std::string> files;        ///< one .ops; or one .can with .opt (a band each), .light and .8
  std::string output;                    ///< the scene file to be: paths in it are relative to its folder
  std::optional<std::string> unit;       ///< of .can and .8 (default m, as CARIBU's scene_unit), or of the plants of an .ops (default cm)
  bool degrees = false;                  ///< .ops: angles are degrees; else radians
  bool finite = false;                   ///< .ops: the terrain does not repeat
  bool soil = false;                     ///< .can: a soil of the pattern's size at the lowest point, with the reflectance of the .opt files
  bool light_states = false;             ///< .light: a state of one second for each direction, whatever the directions are
  std::optional<std::int64_t> scene_id;  ///< .ops with several scenes: the one to take
};

struct ImportedScene {
  std::string text;                ///< TOML
  std::vector<std::string> notes;  ///< what was assumed
};

/// AMAP scenes (.ops, AMAPstudio's Open Plant Scene), and CARIBU cases (.can, .opt, .light, .8; OpenAlea). Throws InputError with file and
/// line, UsageError for files that do not belong together.
ImportedScene import_scene(const ImportChoice& choice);

}  // namespace sunfleck
