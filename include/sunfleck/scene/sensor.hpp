// Sensors: surfaces that measure light and do nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/plant/mesh.hpp>

namespace sunfleck {

struct Scene;

/// Horizontal, front upwards: rows of cells along x from the lowest x and y.
struct SensorGrid {
  double z = 0;  ///< [m]
  std::array<std::uint32_t, 2> cells{1, 1};
  std::optional<std::array<double, 2>> size, centre;  ///< [m]; else those of the periodic cell, the ground, the plants
};

/// Horizontal planes one above the other: the mean flux down (front) and up (back) at each height.
struct SensorProfile {
  double step = 0.1;                                  ///< between heights [m]
  std::optional<double> low, high;                    ///< [m]; else from the lowest to above the highest thing of the scene
  std::optional<std::array<double, 2>> size, centre;  ///< of the planes, as of a grid
};

struct SensorEntry {
  std::string name;
  std::variant<SensorGrid, SensorProfile, Mesh> shape;
  bool both_sides = false;    ///< the back is measured too; always of a profile
  std::uint32_t samples = 0;  ///< rays per cell and side; 0 = the quality's own
};

/// "grid", "profile" or "mesh".
const char* kind_of(const SensorEntry& sensor);

/// A parallelogram or triangle at `corner` with edges `u`, `v`; its front is the side to which u x v points.
struct Patch {
  Vec3 corner, u, v;
  bool triangle = false;

  /// For (x, y) uniform in [0, 1)^2, uniform over the area.
  Vec3 point(double x, double y) const;
  Vec3 centroid() const;
  double area() const;  ///< [m^2]
  Vec3 normal() const;  ///< unit vector of the front; zero without area
};

/// A sensor in the world: k cells, in the order of the result.
struct PlacedSensor {
  const SensorEntry* entry;
  std::vector<Patch> cells;
};

/// Cells of all sensors. `bounds`: of everything in the scene with an area; may be empty. Throws InputError where a size or a range of
/// heights is neither given nor to be had from the scene, or a profile would have more than 100000 heights.
std::vector<PlacedSensor> place_sensors(const Scene& scene, const Box& bounds);

}  // namespace sunfleck
