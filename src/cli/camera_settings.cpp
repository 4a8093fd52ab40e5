#include "cli/camera_settings.hpp"

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

std::optional<Vec3> point(const std::vector<double>& xyz, const char* option) {
  if (xyz.empty()) return std::nullopt;
  if (xyz.size() != 3) throw UsageError(fmt::format("{}: found {} numbers; expected three, x y z in metres", option, xyz.size()));
  return Vec3{xyz[0], xyz[1], xyz[2]};
}

}  // namespace

PictureSettings settings_of_camera(const CameraOptions& options) {
  PictureSettings s;
  s.width = options.width, s.height = options.height, s.samples = options.samples;
  s.camera.eye = point(options.eye, "--eye"), s.camera.target = point(options.target, "--target");
  s.camera.orthographic = options.orthographic;
  if (options.azimuth_deg) s.camera.azimuth_deg = *options.azimuth_deg;
  if (options.elevation_deg) s.camera.elevation_deg = *options.elevation_deg;
  if (options.field_of_view_deg) s.camera.field_of_view_deg = *options.field_of_view_deg;
  return s;
}

}  // namespace sunfleck
