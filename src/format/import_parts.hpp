// Parts of scene files that importers write.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/format/caribu_files.hpp>
#include <sunfleck/format/import_scene.hpp>

namespace sunfleck {

ImportedScene import_amap(const ImportChoice& choice, const std::string& ops);
ImportedScene import_caribu(const ImportChoice& choice);

/// A TOML string with its quotes. InputError if it is no UTF-8.
std::string toml_text(const std::string& text);
/// "{ PAR = 0.1, NIR = 0.2 }"; bare keys where TOML allows them.
std::string band_table(const std::vector<std::string>& bands, const std::vector<double>& values);
/// A path as seen from the folder of the scene file.
std::string path_from(const std::string& scene, const std::string& file);
/// Suffix with its dot, in small letters.
std::string suffix_of(const std::string& file);

/// The light of a .light file as [sun], [sky] or [[state]] tables. Directions whose irradiances are those of their Voronoi cells under a
/// uniform or a standard overcast sky, to 3 % in all, become that sky; others that cover the hemisphere evenly, a sky of those cells
/// (model = "file"); one more than those, or a single one, the sun; else every direction is a state of one second with a sun of its own.
std::string light_tables(const std::vector<LightDirection>& directions, const std::vector<std::string>& bands, bool states,
                         std::vector<std::string>& notes);

}  // namespace sunfleck
