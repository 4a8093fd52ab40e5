// Checks of lamps and sensors, called by check_scene().
#pragma once

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// Throw InputError.
void check_lamps(const Scene& scene);
void check_sensors(const Scene& scene);

}  // namespace sunfleck
