#include <sunfleck/cli/verbs.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/camera_settings.hpp"
#include "cli/output_path.hpp"
#include "cli/result_inputs.hpp"
#include "cli/result_status.hpp"

namespace sunfleck {

namespace {

/// "y=0.5", or "x,y,z,nx,ny,nz".
PictureCut cut_plane(const std::string& text) {
  const auto wrong = [&] {
    return UsageError(
        fmt::format("--cut: found '{}'; expected x, y or z, '=' and a number in metres, or six numbers x,y,z,nx,ny,nz", text));
  };
  const auto number = [&](std::string_view part) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc{} || end != part.data() + part.size() || !std::isfinite(value)) throw wrong();
    return value;
  };
  PictureCut cut;
  if (text.size() > 2 && text[1] == '=' && text[0] >= 'x' && text[0] <= 'z') {
    const int axis = text[0] - 'x';
    cut.point[axis] = number(std::string_view(text).substr(2));
    cut.normal[axis] = 1;
    cut.facing_eye = true;
    return cut;
  }
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    values.push_back(number(std::string_view(text).substr(at, comma - at)));
    at = comma + 1;
  }
  if (values.size() != 6) throw wrong();
  cut.point = {values[0], values[1], values[2]}, cut.normal = {values[3], values[4], values[5]};
  if (!(glm::length(cut.normal) > 0)) throw wrong();
  return cut;
}

std::size_t rgb_band(const Result& result, const std::string& name) {
  const auto& bands = result.bands();
  const auto at = std::find(bands.begin(), bands.end(), name);
  if (at == bands.end())
    throw UsageError(fmt::format("--rgb: found '{}'; expected three of the bands in {}: {}", name, result.file(), joined(bands)));
  return static_cast<std::size_t>(at - bands.begin());
}

bool is_exr(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix == ".exr";
}

PictureSettings settings_of(const RenderOptions& options) {
  PictureSettings s = settings_of_camera(options);
  s.infinite = options.infinite, s.map_ground = options.map_ground;
  s.views = options.views;
  if (!options.cut.empty()) s.cut = cut_plane(options.cut);
  if (options.background == "white") s.background = Background::white;
  s.exposure_stops = options.exposure_stops, s.scale_bar = options.scale_bar;
  s.layers = is_exr(options.output);
  return s;
}

}  // namespace

int verb_render(const RenderOptions& options, Progress& progress) {
  const Stopwatch watch;
  check_output_path(options.output, {".png", ".exr"}, {options.result, options.reference.value_or("")});
  const PictureSettings settings = settings_of(options);
  const Result result(options.result);
  say_status(result, progress);
  const std::size_t state = state_row(result, options.state);
  const std::size_t band = band_row(result, options.band);
  const std::string quantity = options.quantity.value_or("colour");
  std::optional<Result> reference;
  if (options.reference) reference.emplace(*options.reference);
  note_inputs_of(result);
  prepare_outputs({options.output}, progress);
  const DrawnScene scene(result, options.ground);
  if (settings.infinite && !scene.geometry().periodic) progress.line("note: --infinite: the scene is not periodic; it is drawn as it is");

  const Picture picture = [&] {
    if (quantity != "colour") {
      MapChoice choice{.quantity = quantity,
                       .band = band,
                       .state = state,
                       .map = color_map_from_name(options.colormap.value_or(has_two_signs(quantity) ? "difference" : "viridis")),
                       .logarithmic = options.logarithmic,
                       .ground = options.map_ground,
                       .range = options.range};
      if (reference) choice.reference = &*reference;
      return draw_map(scene, stored_map(result, scene, choice, progress), settings, progress);
    }
    LightSource light = stored_light(result, scene, state);
    if (options.band) light.colours = ColourBands{{band, band, band}, false};
    if (!options.rgb.empty()) {
      light.colours.emplace().measured = true;
      for (std::size_t i = 0; i < 3; ++i) light.colours->rgb[i] = rgb_band(result, options.rgb[i]);
    }
    return draw_natural(scene, light, settings, progress);
  }();
  if (picture.layers)
    write_exr(*picture.layers, options.output);
  else
    write_png(picture.image, options.output);
  progress.line(fmt::format("{}: {} x {} pixels, {} of {} facets, {:.1f} s", options.output, picture.image.width(), picture.image.height(),
                            quantity, scene.size(), watch.seconds()));
  return 0;
}

}  // namespace sunfleck
