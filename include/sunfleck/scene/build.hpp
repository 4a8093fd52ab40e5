// Scenes made in memory: the same parts that the scene file names, as functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

/// How a copy stands. Applied in this order: scale, mirror (x -> -x), turn about the vertical, tilt, move.
struct Stance {
  Vec3 position{0.0};           ///< [m]
  double turn_deg = 0;          ///< counter-clockwise seen from above
  double scale = 1;             ///< > 0
  double tilt_deg = 0;          ///< the copy's vertical leans by this ...
  double tilt_azimuth_deg = 0;  ///< ... towards this azimuth, from north (+y) over east (+x)
  bool mirror = false;
};

/// The map of a copy that stands so.
Placement placed(const Stance& stance);

/// Optics with the same reflectance on both sides, one value per band.
Optics uniform_optics(const std::string& name, const std::vector<double>& reflectance, const std::vector<double>& transmittance);

/// A plant all of whose shapes have optics row `optics` of the scene.
PlantEntry plant_entry(const std::string& name, Plant plant, std::uint32_t optics, std::vector<Placement> placements);

/// Flat ground; in a periodic scene pass its cell's size and centre.
Ground flat_ground(std::array<double, 2> size, std::array<double, 2> centre, std::array<std::uint32_t, 2> cells,
                   const std::vector<double>& reflectance);

/// Throws InputError(where, ...) unless the ground spans the periodic cell in x and y.
void check_ground_fills(const Ground& ground, const PeriodicCell& cell, const std::string& where);

/// Rows of Scene::groups that hold each other in a circle, the first one repeated at the end; empty if there is none.
std::vector<std::uint32_t> group_cycle(const Scene& scene);

}  // namespace sunfleck
