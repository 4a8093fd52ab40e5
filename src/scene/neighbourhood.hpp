// What stands about those placements that are opened.
#pragma once

#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

/// Fills PlacedScene::near, far, near_ground, far_ground for what is closed.
void add_neighbourhood(const Scene& scene, PlacedScene& placed);

}  // namespace sunfleck
