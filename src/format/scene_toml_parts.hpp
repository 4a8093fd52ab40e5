// What the parts of the scene reader share: one file a topic, read in the order of read_scene().
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/scene/run_settings.hpp>
#include <sunfleck/scene/scene.hpp>

#include <format/toml_value.hpp>

namespace sunfleck {

/// One value per band from { PAR = 1.0, NIR = 2.0 }: every band must be there; each is checked by `check`.
std::vector<double> read_per_band(const TomlValue& table, const Scene& scene, const std::function<double(const TomlValue&)>& read);

/// A path given relative to the scene file; throws InputError at the value if it is missing or a folder.
std::string read_path(const TomlValue& value, const Scene& scene, const std::string& expected);

// scene_toml_light.cpp
TomlSchema sun_schema(const TomlSchema& per_band);
TomlSchema global_schema(const TomlSchema& per_band);
/// [sun], [sky], [global] or [[state]] -> Scene::states.
void read_light(const TomlValue& root, Scene& scene);

// scene_toml_sky.cpp
TomlSchema sky_schema(const TomlSchema& per_band);
/// The directions and radiances that a sky of model = "file" has.
std::shared_ptr<const SkyTable> read_sky_table(const TomlValue& sky, const Scene& scene);

// scene_toml_sky_kinds.cpp
/// What a sky may know of the state that it is part of.
struct StateAround {
  std::optional<Vec3> sun;                         ///< where it stands, also below the horizon
  int day_of_year = 0;                             ///< 0 = no date
  std::vector<double> beam;                        ///< per band, on a plane that faces the sun; empty without a sun
  std::optional<std::array<double, 2>> shortwave;  ///< by [global]: the beam and the diffuse light of all wavelengths [W m^-2]
};
/// The weather of a sky of model = "perez" that has `irradiance` per band.
PerezWeather read_perez_weather(const TomlValue& sky, Scene& scene, const StateAround& around, const std::vector<double>& irradiance);

/// A picture, and its sun where it is kept. No picture where all light is the sun's.
struct PicturedSky {
  std::shared_ptr<const SkyImage> image;
  std::optional<PicturedSun> sun;
};
PicturedSky read_sky_picture(const TomlValue& sky, Scene& scene, bool has_sun);

// scene_toml_optics.cpp
TomlSchema optics_schema(const TomlSchema& per_band);
TomlSchema ground_schema(const TomlSchema& per_band);
void read_optics(const TomlValue& root, Scene& scene);
/// `given`: what a scene in memory has in the place of a mesh file; so for lamps and sensors.
void read_ground(const TomlValue& root, Scene& scene, const Mesh* given = nullptr);
/// All faces of a mesh file as one mesh, in their order; what its reader noted is appended.
Mesh read_flat_mesh(const std::string& file, double unit_m, std::vector<std::string>& notes);

// scene_toml_placements.cpp
/// Keys of one placement: position, turn, scale, tilt, tilt_azimuth, mirror, grid, file.
TomlSchema placement_schema(const std::vector<std::string>& further_keys);
TomlSchema grid_schema();
std::vector<Placement> read_grid(const TomlValue& grid);
/// Placements of one entry: itself, the cells of its grid, or the rows of its CSV file.
std::vector<Placement> read_placements(const TomlValue& entry, const Scene& scene);

// scene_toml_plants.cpp
TomlSchema plant_schema();
TomlSchema group_schema();
/// [[plant]], [[group]] and [[place]].
void read_plants_and_groups(const TomlValue& root, Scene& scene);
/// Metres per unit: m, cm, mm, inch, foot.
double read_unit(const TomlValue& owner);

// scene_toml_devices.cpp
TomlSchema lamp_schema(const TomlSchema& per_band);
TomlSchema sensor_schema();
/// [[lamp]] -> Scene::lamps and [[sensor]] -> Scene::sensors, when the states are known.
void read_lamps(const TomlValue& root, Scene& scene, const Mesh* given = nullptr);
void read_sensors(const TomlValue& root, Scene& scene, const Mesh* given = nullptr);

// scene_toml_choices.cpp
TomlSchema output_schema();
TomlSchema solve_schema();
void read_output(const TomlValue& root, OutputChoice& out);
void read_solve(const TomlValue& root, RunSettings& run);

}  // namespace sunfleck
