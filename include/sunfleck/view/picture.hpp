// Ray-traced pictures of a lit scene: in natural colour, or as a map of a quantity.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/view/camera.hpp>
#include <sunfleck/view/image.hpp>
#include <sunfleck/view/legend.hpp>

namespace sunfleck {

/// Light on the facets of a scene in one lighting state; n facets, b bands.
struct FacetLight {
  std::vector<std::string> bands;                  ///< [b]
  std::optional<std::size_t> band = std::nullopt;  ///< the one band to draw with a guessed hue; none: colour_bands()
  std::vector<float> irradiance;                   ///< [n][2][b] front, back [W m^-2]
  std::vector<float> sunlit;                       ///< [n][2] fraction of the side that the sun reaches; may be empty
  std::optional<Sun> sun;                          ///< the state's sun; its beam is drawn sharp where `sunlit` is there too
};

/// A number, or the row of a name, for every facet.
struct FacetMap {
  std::vector<std::string> title;  ///< lines over the legend
  bool sides = false;              ///< true: [n][2] and the side that the camera sees is drawn; false: [n]
  std::vector<float> values;       ///< NaN is drawn grey
  ValueScale scale;
  ColorMap map = ColorMap::viridis;
  std::vector<std::string> names;  ///< not empty: values are rows of these names, and the legend is a list
};

struct PictureSettings {
  int width = 1200, height = 900;  ///< [pixels]
  int samples = 9;                 ///< per pixel, in strata; rounded up to a square number
  CameraChoice camera;
  bool infinite = false;    ///< a periodic scene is drawn with its repetition to the horizon, else its one cell
  bool map_ground = false;  ///< a map colours the ground by its values too; else it is light grey
};

/// Natural colour. Each camera ray finds the facet it hits; its side's exitance (facet_colour) is tone-mapped with one exposure for the
/// whole picture.
///  - Stored irradiance is one value a side; it is drawn interpolated over neighbouring facets of an organ, and of the ground,
///    that meet at less than 60 degrees.
///  - Where the sun and the sunlit fractions are known, the sun's mean share, sunlit x E_sun |cos|, is taken out of it and the beam is
///  traced at the
///    very point instead (a shadow ray into the disc), so shadows are sharp and their mean over a facet is the stored one.
///  - Sky and haze behind the scene are decoration; so is, around the ground of a scene that does not repeat, its continuation at its
///  lowest
///    height in the mean colour of its least shaded fifth.
/// The same bits for any number of threads. Throws UsageError for impossible settings, Stopped when cancelled.
Image draw_natural(const FacetScene& scene, const FacetLight& light, const PictureSettings& settings, Progress& progress);

/// A map with its legend on the right. Numbers keep the legend's exact colours (no shading); names are shaded by the angle
/// of view to show shape.
Image draw_map(const FacetScene& scene, const FacetMap& map, const PictureSettings& settings, Progress& progress);

}  // namespace sunfleck
