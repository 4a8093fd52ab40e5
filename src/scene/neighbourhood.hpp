// What stands about those placements that are opened.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sunfleck/scene/placed_scene.hpp>

namespace sunfleck {

/// Fills PlacedScene::near, far, near_ground, far_ground for what is closed.
void add_neighbourhood(const Scene& scene, PlacedScene& placed);

/// Two triangles a cell, rows along x from the lowest x and y, front upwards. `field`: x_low, y_low, x_high, y_high [m].
std::vector<Triangle> ground_cells(const std::array<double, 4>& field, const std::array<std::uint32_t, 2>& cells, double height);

}  // namespace sunfleck
