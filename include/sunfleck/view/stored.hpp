// What pictures need of a result file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/picture.hpp>

namespace sunfleck {

/// The scene of a result as it was solved: corners, area, optics, organs, materials, period. Without `ground`, plants only.
/// Works for files that keep organs only. Throws InputError where the file holds no geometry, or nothing to draw is left.
FacetScene stored_scene(const Result& result, bool ground = true);

/// Row of a state by its name, or by its number counted from 1; the first where none is given. Throws UsageError with the nearest name.
std::size_t state_row(const Result& result, const std::optional<std::string>& state);
/// The same of states' names in the order of a scene; `file` for errors.
std::size_t state_row(std::vector<std::string> names, const std::string& file, const std::optional<std::string>& state);
/// Row of a band by its name; where none is given that of PAR, else the first. Throws UsageError with the nearest name.
std::size_t band_row(const Result& result, const std::optional<std::string>& band);

/// The same read a range at a time; the result must outlive it.
LightSource stored_light(const Result& result, const DrawnScene& scene, std::size_t state);

/// Light on the facets of stored_scene(); where the file keeps organs only, every facet has its organ's mean. Throws InputError
/// where it keeps neither.
StateLight stored_light(const Result& result, const FacetScene& scene, std::size_t state);

/// What draw_map() can show: see docs/render.md.
const std::vector<std::string>& quantity_names();

struct MapChoice {
  std::string quantity = "absorbed";
  std::size_t band = 0, state = 0;
  ColorMap map = ColorMap::viridis;
  bool logarithmic = false;
  bool ground = false;                ///< the ground's facets count for the scale too
  std::vector<double> range;          ///< low, high; empty = from the plants' facets (the ground's where there are no plants)
  const Result* reference = nullptr;  ///< of "error" and "organ_error"
};
/// True for quantities on both sides of zero ("error", "organ_error"), which ColorMap::difference suits; their scale is symmetric.
bool has_two_signs(const std::string& quantity);
/// Values of a quantity with scale, title and unit. Throws UsageError for an unknown quantity (with the nearest name), a
/// range that is empty, not finite, or not positive where logarithmic, or an error without a reference; InputError where a file does not
/// keep it, or the reference is not of the same scene.
FacetMap stored_map(const Result& result, const FacetScene& scene, const MapChoice& choice);
/// The same read a range at a time; results and scene must outlive it. The scale of more than 2^24 facets comes from 256 blocks of 2^16,
/// evenly spread.
MapSource stored_map(const Result& result, const DrawnScene& scene, const MapChoice& choice, Progress& progress);

}  // namespace sunfleck
