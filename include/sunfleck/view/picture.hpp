// Ray-traced pictures of a lit scene: in natural colour, or as a map of a quantity.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/scene/facets.hpp>
#include <sunfleck/view/camera.hpp>
#include <sunfleck/view/drawn_scene.hpp>
#include <sunfleck/view/image.hpp>
#include <sunfleck/view/layers.hpp>
#include <sunfleck/view/legend.hpp>

namespace sunfleck {

/// Light on the facets of a scene in one lighting state; n facets, b bands.
struct StateLight {
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

/// Plants on the side of a plane that `normal` points to are not drawn; ground and light stay as they are.
struct PictureCut {
  Vec3 point{0.0};          ///< [m]
  Vec3 normal{0.0};         ///< any length
  bool facing_eye = false;  ///< takes the side on which the first view's camera stands, whatever the sign of the normal
};

/// What is behind the scene: sky with ground to the horizon, or white paper.
enum class Background : std::uint8_t { sky, white };

struct PictureSettings {
  int width = 1200, height = 900;  ///< [pixels]
  int samples = 9;                 ///< per pixel, in strata; rounded up to a square number
  CameraChoice camera;
  bool infinite = false;    ///< a periodic scene is drawn with its repetition to the horizon, else its one cell
  bool map_ground = false;  ///< a map colours the ground by its values too; else it is light grey
  /// Several views in one picture, in rows from the top left: names of view_names(). "camera" is the camera above; the others are parallel
  /// projections, all to one scale. Empty: the camera alone, without a caption.
  std::vector<std::string> views;
  std::optional<PictureCut> cut;
  Background background = Background::sky;              ///< of natural colour
  double exposure_stops = 0;                            ///< natural colour: brighter by factors of two
  bool scale_bar = false;                               ///< in parallel projections
  bool layers = false;                                  ///< fills Picture::layers
  std::size_t most_value_bytes = std::size_t{1} << 28;  ///< values of the scene that are held whole; of more, those of facets that are seen
};

/// "camera"; "front" (seen from the south), "back", "left" (from the west), "right" (from the east), "top" (north up), "bottom".
const std::vector<std::string>& view_names();

/// What draw_natural() needs of the light, read a range of facets at a time, only where something is seen; n facets, b bands.
struct LightSource {
  std::vector<std::string> bands;                     ///< [b]
  std::optional<ColourBands> colours = std::nullopt;  ///< none: colour_bands()
  std::optional<Sun> sun;                             ///< its beam is drawn sharp where `sunlit` is there too
  using Read = std::function<std::vector<float>(std::size_t first, std::size_t count)>;
  Read irradiance;                           ///< [count][2][b] front, back [W m^-2]
  Read sunlit;                               ///< [count][2] fraction of the side that the sun reaches; may be empty
  std::size_t block = std::size_t{1} << 17;  ///< facets that are read together where any of them is seen
};

/// Reads from a light in memory, which must outlive it, over `facets` facets.
LightSource light_source(const StateLight& light, std::size_t facets);

/// What draw_map() needs of a map, read in the same way.
struct MapSource {
  std::vector<std::string> title;  ///< lines over the legend
  bool sides = false;              ///< true: [count][2] and the side that the camera sees is drawn; false: [count]
  LightSource::Read values;        ///< NaN is drawn grey
  ValueScale scale;
  ColorMap map = ColorMap::viridis;
  std::vector<std::string> names;  ///< not empty: values are rows of these names, and the legend lists those in the picture
};

struct Picture {
  Image image;
  std::optional<PictureLayers> layers;
};

/// As below, of a scene that is not written out: memory for the distinct meshes, a bit for each facet and the values of the facets that are
/// seen. Values are read from one thread at a time, ranges rising.
Picture draw_natural(const DrawnScene& scene, const LightSource& light, const PictureSettings& settings, Progress& progress);
Picture draw_map(const DrawnScene& scene, const MapSource& map, const PictureSettings& settings, Progress& progress);

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
Image draw_natural(const FacetScene& scene, const StateLight& light, const PictureSettings& settings, Progress& progress);

/// A map with its legend on the right. Numbers keep the legend's exact colours (no shading); names are shaded by the angle
/// of view to show shape.
Image draw_map(const FacetScene& scene, const FacetMap& map, const PictureSettings& settings, Progress& progress);

}  // namespace sunfleck
