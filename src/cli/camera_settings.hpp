// What the command line says of cameras.
#pragma once

#include <sunfleck/cli/verbs.hpp>
#include <sunfleck/view/picture.hpp>

namespace sunfleck {

/// Size and camera; all else by default. Throws UsageError.
PictureSettings settings_of_camera(const CameraOptions& options);

}  // namespace sunfleck
