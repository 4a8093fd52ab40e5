// A scene as its user describes it: bands, light, optics, ground, plants and how they are placed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/light/state.hpp>
#include <sunfleck/plant/optics.hpp>
#include <sunfleck/plant/plant.hpp>
#include <sunfleck/scene/lamp.hpp>
#include <sunfleck/scene/placement.hpp>
#include <sunfleck/scene/sensor.hpp>

namespace sunfleck {

/// The cell that repeats without end in x and y [m].
/// On a slope its images stand at (width, 0, width slope_x) and (0, depth, depth slope_y): along an inclined plane without end.
struct PeriodicCell {
  double x_low = 0, y_low = 0, x_high = 1, y_high = 1;
  double slope_x = 0, slope_y = 0;  ///< dz/dx, dz/dy [-]
  bool is_level() const { return slope_x == 0 && slope_y == 0; }
  /// Out of the plane, as long as a vertical step of 1 brings: a point's height above the plane through the origin, the same in all images;
  /// of a unit vector what it gains of it per metre, negative for those that lead into the slope. The plain z of a level cell.
  double above(const Vec3& v) const { return v.z - slope_x * v.x - slope_y * v.y; }
  /// The same vector in a frame whose z is above(): images of what stands on the plane become images of level cells.
  Vec3 levelled(const Vec3& v) const { return {v.x, v.y, above(v)}; }
  /// From a cell to its image some cells on in x and y.
  Vec3 image(double x, double y) const { return {x * width(), y * depth(), x * width() * slope_x + y * depth() * slope_y}; }
  double width() const { return x_high - x_low; }
  double depth() const { return y_high - y_low; }
  double area() const { return width() * depth(); }
};

/// Lambertian ground: rows of cells along x from the lowest x and y, two facets a cell, front upwards; or a mesh.
struct Ground {
  std::array<double, 2> size{1, 1};    ///< [m]
  std::array<double, 2> centre{0, 0};  ///< [m]
  std::array<std::uint32_t, 2> cells{1, 1};
  double height = 0.0;       ///< [m]
  std::optional<Mesh> mesh;  ///< takes the place of size, centre, cells, height
  Optics optics;             ///< reflectance_front = reflectance_back, transmittance 0
};

/// A plant of the scene; `plant` is shared where two entries read the same file with the same unit.
struct PlantEntry {
  std::string name;
  std::shared_ptr<const Plant> plant;       ///< lengths in metres
  std::vector<std::uint32_t> shape_optics;  ///< per shape of the plant, row of Scene::optics
  std::string policy_file;                  ///< empty = none
  std::vector<Placement> placements;        ///< in the world
};

/// A structure made of plants or other groups.
struct GroupEntry {
  struct Member {
    bool is_group = false;
    std::uint32_t index = 0;  ///< row of Scene::plants or Scene::groups (a group of lower row or any, never a cycle)
    Placement placement;
  };
  std::string name;
  std::vector<Member> members;
  std::vector<Placement> placements;  ///< in the world
};

struct Scene {
  std::string file;  ///< empty if built in memory
  std::string text;  ///< TOML as read
  std::vector<std::string> bands;
  std::vector<std::string> band_units;  ///< per band: "W m^-2" or "umol m^-2 s^-1"
  std::optional<PeriodicCell> periodic;
  std::vector<LightState> states;  ///< at least one
  std::vector<Optics> optics;      ///< of plants
  std::optional<Ground> ground;
  std::vector<PlantEntry> plants;
  std::vector<GroupEntry> groups;
  std::vector<LampEntry> lamps;
  std::vector<SensorEntry> sensors;
  std::vector<std::string> notes;  ///< what the reader wants the user to know ("sun below the horizon in state ...")

  std::size_t band_count() const { return bands.size(); }
};

/// Does any surface, of plants or the ground, send on any light?
inline bool scatters(const Scene& scene) {
  return std::any_of(scene.optics.begin(), scene.optics.end(), [](const Optics& o) { return scatters(o); }) ||
         (scene.ground && scatters(scene.ground->optics));
}

/// Physics at the door, for scenes read or built in memory: at least one band and state, finite and non-negative irradiances,
/// rho + tau <= 1, finite vertices, no cycle among groups, ground that fills a periodic cell. Throws InputError.
void check_scene(const Scene& scene);

}  // namespace sunfleck
