// What the sun's lines go through: how far apart they are for whom, and the ground in their way.
#pragma once

#include <memory>
#include <vector>

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/visibility/copies.hpp>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Distance of the sun's lines for a member's own organs [m].
double own_sun_pitch(const OriginalLight& original, const Similarity& map, const InstantiationDensity& density);

/// Distance of the sun's lines for each member in which light is solved [m]. Members whose organs differ by less than sixteen times in area
/// are lit by the same lines, those that the smallest of them needs; larger ones by coarser lines of their own, so that a wall beside grass
/// is not lit blade by blade.
std::vector<double> sun_pitches(const Members& members, const InstantiationDensity& density);

/// The ground as it shades: null where it cannot, since nothing that light is solved in reaches below its highest point. It is lowered
/// as rays meet it: what lies on it is lit.
std::unique_ptr<const Surface> shading_ground(const Scene& scene, const Members& members);

}  // namespace sunfleck
