// What a request asks to see.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/view/camera.hpp>
#include <sunfleck/view/colormap.hpp>
#include <sunfleck/view/legend.hpp>

#include "view/viewer_scene.hpp"

namespace sunfleck {

/// Values of a request's parameters; none if a name is absent.
using Parameters = std::function<std::optional<std::string>(const std::string& name)>;

/// Facets with normal . p > offset are cut away.
struct CutPlane {
  Vec3 normal{0, 0, 1};  ///< unit
  double offset = 0;     ///< [m]
};

/// The numbers shown: a quantity of one result, or of the second less the first.
struct ShownQuantity {
  std::string quantity = "colour";  ///< "colour" or one of quantity_names()
  std::size_t band = 0, state = 0;
  bool difference = false;
};

struct OrbitCamera {
  double azimuth_deg = 150, elevation_deg = 25;  ///< where the camera stands, seen from the target (as in CameraChoice)
  double distance = 1;                           ///< from eye to target [m]
  Vec3 target{0.0};
  double field_of_view_deg = 35;
  bool orthographic = false;  ///< the picture is then as high as a perspective one at the target
};

/// Everything that decides about a picture but the time spent on it.
struct ViewerView {
  std::size_t result = 0;  ///< whose scene is drawn
  ShownQuantity shown;
  ColorMap map = ColorMap::viridis;
  bool logarithmic = false;
  std::optional<std::array<double, 2>> range;
  OrbitCamera camera;
  std::optional<CutPlane> cut;
  std::string selection;                   ///< see selected_organs()
  bool only_selected = false;              ///< hides the rest instead of paling it
  bool ground = true;                      ///< drawn
  bool map_ground = false;                 ///< coloured by its values
  bool infinite = false;                   ///< a periodic scene repeats
  bool dark = false;                       ///< paper behind maps
  double exposure_stops = 0;               ///< of natural colour
  std::optional<std::uint32_t> highlight;  ///< organ with an outline
  int width = 0, height = 0;

  /// Equal for equal pictures.
  std::string key() const;
};

/// The scenes that are open: one, or two to compare.
using ViewerScenes = std::vector<std::shared_ptr<const ViewerScene>>;

/// Reads and checks the parameters. Throws UsageError that names parameter, what was found and what was expected.
ShownQuantity read_quantity(const Parameters& parameters, const ViewerScenes& scenes, std::size_t result);
ViewerView read_view(const Parameters& parameters, const ViewerScenes& scenes);
/// Of single parameters, with the same errors.
double read_number(const Parameters& parameters, const std::string& name, double fallback, double low, double high);
std::size_t read_count(const Parameters& parameters, const std::string& name, std::size_t fallback, std::size_t low, std::size_t high);
bool read_flag(const Parameters& parameters, const std::string& name, bool fallback);

Camera camera_of(const OrbitCamera& orbit, double aspect);

/// One flag an organ. Empty text: every organ of the plants. Else parts joined by ';', all of which must hold: "placement:", "plant:",
/// "type:", "organ:" followed by rows and ranges of rows such as "0-3,7". Throws UsageError.
std::vector<std::uint8_t> selected_organs(const FacetScene& scene, const std::string& selection);

}  // namespace sunfleck
