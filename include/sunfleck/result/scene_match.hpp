// Whether two results are of one scene, so that their rows may be set against each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// How far two results are of one scene.
struct SceneMatch {
  /// What keeps their rows from being compared: bands, number of states, organs, their areas, facets, where facets lie and face.
  struct Difference {
    std::string found, expected;  ///< in the first; in the second
  };
  std::optional<Difference> difference;
  /// What else differs, a sentence each: the light of the states, lamps, optics, names of plants and organs.
  std::vector<std::string> notes;
};

/// Places of the facets count as one where they differ by less than a thousandth of the facet's size and a millionth of the scene's, and
/// so for the way that they face; areas of organs, by less than 1e-4 of them. Where a file keeps neither meshes nor centroids, or
/// where `places` is false, places are not looked at: plants that were moved or turned are then compared row by row.
SceneMatch match_scenes(const Result& result, const Result& reference, bool places = true);

/// The notes of match_scenes(); throws InputError naming the first file for a difference.
std::vector<std::string> check_same_scene(const Result& result, const Result& reference, bool places = true);

}  // namespace sunfleck
