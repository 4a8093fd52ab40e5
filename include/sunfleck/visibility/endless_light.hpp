// Light of lamps that can never end.
#pragma once

#include <sunfleck/scene/scene.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

/// A closed cavity in which nothing absorbs fills with light for ever: with a lamp inside there is no solution. Sends a few particles
/// from every lamp that shines, and throws InputError if one of them, in some band, meets 100000 surfaces without any that absorbs
/// (reflectance + transmittance < 1) and without leaving the scene. Costs nothing unless a lamp shines and something absorbs nothing.
void check_lamplight_ends(const Scene& scene, const RayScene& rays);

}  // namespace sunfleck
