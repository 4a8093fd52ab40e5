#include <sunfleck/cli/verbs.hpp>

#include <array>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/output_path.hpp"

namespace sunfleck {

namespace {

std::optional<Vec3> point(const std::vector<double>& xyz, const char* option) {
  if (xyz.empty()) return std::nullopt;
  if (xyz.size() != 3) throw UsageError(fmt::format("{}: found {} numbers; expected three, x y z in metres", option, xyz.size()));
  return Vec3{xyz[0], xyz[1], xyz[2]};
}

PictureSettings settings_of(const RenderOptions& options) {
  PictureSettings s;
  s.width = options.width, s.height = options.height, s.samples = options.samples;
  s.infinite = options.infinite, s.map_ground = options.map_ground;
  s.camera.eye = point(options.eye, "--eye"), s.camera.target = point(options.target, "--target");
  s.camera.orthographic = options.orthographic;
  if (options.azimuth_deg) s.camera.azimuth_deg = *options.azimuth_deg;
  if (options.elevation_deg) s.camera.elevation_deg = *options.elevation_deg;
  if (options.field_of_view_deg) s.camera.field_of_view_deg = *options.field_of_view_deg;
  return s;
}

}  // namespace

int verb_render(const RenderOptions& options, Progress& progress) {
  const Stopwatch watch;
  check_output_path(options.output, {".png"}, {options.result});
  const PictureSettings settings = settings_of(options);
  const Result result(options.result);
  const std::size_t state = state_row(result, options.state);
  const std::size_t band = band_row(result, options.band);
  const std::string quantity = options.quantity.value_or("colour");
  const FacetScene scene = stored_scene(result, options.ground);
  if (settings.infinite && !scene.periodic) progress.line("note: --infinite: the scene is not periodic; it is drawn as it is");

  Image image = [&] {
    if (quantity != "colour") {
      const MapChoice choice{.quantity = quantity,
                             .band = band,
                             .state = state,
                             .map = color_map_from_name(options.colormap.value_or("viridis")),
                             .logarithmic = options.logarithmic,
                             .ground = options.map_ground,
                             .range = options.range};
      return draw_map(scene, stored_map(result, scene, choice), settings, progress);
    }
    FacetLight light = stored_light(result, scene, state);
    if (options.band) light.band = band;
    return draw_natural(scene, light, settings, progress);
  }();
  write_png(image, options.output);
  progress.line(fmt::format("{}: {} x {} pixels, {} of {} facets, {:.1f} s", options.output, image.width(), image.height(), quantity,
                            scene.size(), watch.seconds()));
  return 0;
}

}  // namespace sunfleck
