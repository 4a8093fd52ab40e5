// Skies part by part, for what knows them along some directions only.
#pragma once

#include <functional>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/light/sky.hpp>

namespace sunfleck {

/// A part of the upper hemisphere: its middle, the horizontal irradiance that it brings, of 1 of all [-], and that of a sky of radiance 1
/// [sr].
using VisitPart = std::function<void(const Vec3& middle, double light, double level)>;

/// Cuts the upper hemisphere into at least so many parts, the pixels of a picture or finer, and visits each; also what a slope hides.
void each_part(const Sky& sky, std::size_t fewest, const VisitPart& visit);

/// May it be bright in places that are narrow against the angles between some hundred directions?
inline bool has_detail(const Sky& sky) {
  return sky.model == SkyModel::perez || !sky.is_formula();
}

/// A sky of `directions` (model `file`) with nearly the same light: each has the mean radiance of what is nearer to it than to any other.
/// Skies without detail stay as they are. The directions are unit vectors at or above the horizon, each once.
Sky in_cells(const Sky& sky, const std::vector<Vec3>& directions);

/// Radiances along many directions that are spread evenly over a hemisphere: of the cell of each where the sky has detail, scaled so that
/// all together bring a horizontal plane what the sky does; dark for those below the horizon.
std::vector<double> radiances_along(const Sky& sky, const std::vector<Vec3>& directions);

/// A sky (model `image`) whose radiances are means over a disc of an angular radius [rad], what is above the horizon of it, with weights
/// that fall to its rim: for directions that are so far apart, wherever they point. Skies without detail stay as they are.
Sky blurred(const Sky& sky, double radius);

}  // namespace sunfleck
