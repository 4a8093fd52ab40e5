// Parts of scenes that are made in memory, in the words of scene files: a text is TOML as docs/formats-scene.md describes it.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

// Each takes one topic of a scene file, checks it as the file reader does, and returns what its user should know. Paths in it are relative
// to Scene::file, or to the working folder where that is empty. Throws InputError that names the key; then the scene is as it was. `mesh`
// takes the place of a mesh file; null = the text names one, or none.

/// [sun], [sky] and [global], or [[state]]: takes the place of Scene::states.
std::vector<std::string> replace_light(Scene& scene, const std::string& text);
/// [optics.NAME]. A name that the scene has already is an error, or is replaced.
std::vector<std::string> add_optics(Scene& scene, const std::string& text, bool replace = false);
/// [ground]: takes the place of Scene::ground.
std::vector<std::string> replace_ground(Scene& scene, const std::string& text, const Mesh* mesh = nullptr);
/// [[plant]] with a file and without a place.
std::vector<std::string> add_plant(Scene& scene, const std::string& text);
/// [[lamp]]; `states` are those that the scene has now.
std::vector<std::string> add_lamp(Scene& scene, const std::string& text, const Mesh* mesh = nullptr);
/// [[sensor]].
std::vector<std::string> add_sensor(Scene& scene, const std::string& text, const Mesh* mesh = nullptr);

/// `place`: an array of positions, grids or CSV files.
std::vector<Placement> read_places(const Scene& scene, const std::string& text);

}  // namespace sunfleck
