// Scenes that go on without end along a slope.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// The steepest slope of an endless scene, dz over the way downhill [-]: 84 degrees.
inline constexpr double steepest_slope = 10.0;

/// Does the cell repeat along a plane that is not level?
bool lies_on_slope(const Scene& scene);

/// What the slope makes of a scene: flat ground leans with it, through (0, 0, height); skies are dark below its plane; suns behind it are
/// no suns. Says which. A scene that is not on a slope, or was laid on it before, stays as it is.
std::vector<std::string> lay_on_slope(Scene& scene);

/// The direction lifted so that it leads out of the cell's plane by `least` per length, unless it does by more; on level ground to z =
/// least.
Vec3 lifted(const PeriodicCell& cell, const Vec3& d, double least);

}  // namespace sunfleck
