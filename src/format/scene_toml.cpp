#include <sunfleck/format/scene_toml.hpp>

#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/scene/extent.hpp>
#include <sunfleck/scene/plant_sizes.hpp>
#include <sunfleck/scene/slope.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

/// Names of bands where they can be read, so that keys can be checked before values.
std::vector<std::string> band_names_if_any(const TomlValue& root) {
  std::vector<std::string> names;
  const auto bands = root.get("bands");
  if (!bands || !bands->is_array()) return names;
  for (const auto& item : bands->items())
    if (item.is_text()) names.push_back(item.text());
  return names;
}

TomlSchema scene_schema(const std::vector<std::string>& bands) {
  // Without bands their names cannot be told from misspelt ones.
  const TomlSchema per_band = bands.empty() ? TomlSchema::names(TomlSchema::leaf()) : TomlSchema::of(bands);
  const TomlSchema state = TomlSchema::of(
      {"name", "duration_s"}, {{"sun", sun_schema(per_band)}, {"sky", sky_schema(per_band)}, {"global", global_schema(per_band)}});
  return TomlSchema::of({"bands"}, {{"units", per_band},
                                    {"domain", TomlSchema::of({"periodic", "slope"})},
                                    {"sun", sun_schema(per_band)},
                                    {"sky", sky_schema(per_band)},
                                    {"global", global_schema(per_band)},
                                    {"state", state},
                                    {"lamp", lamp_schema(per_band)},
                                    {"optics", TomlSchema::names(optics_schema(per_band))},
                                    {"ground", ground_schema(per_band)},
                                    {"plant", plant_schema()},
                                    {"group", group_schema()},
                                    {"place", placement_schema({"plant", "group"})},
                                    {"sensor", sensor_schema()},
                                    {"output", output_schema()},
                                    {"solve", solve_schema()}});
}

void read_bands(const TomlValue& root, Scene& scene) {
  const auto bands = root.need("bands", "the names of the spectral bands, like [\"PAR\", \"NIR\"]");
  if (!bands.is_array()) bands.fail("an array of names, like [\"PAR\", \"NIR\"]");
  std::set<std::string> seen;
  for (const auto& item : bands.items()) {
    scene.bands.push_back(item.text());
    if (!seen.insert(scene.bands.back()).second) item.fail(fmt::format("\"{}\" twice", scene.bands.back()), "every band once");
  }
  if (scene.bands.empty()) bands.fail("at least one band");
  scene.band_units.assign(scene.bands.size(), "W m^-2");
  const auto units = root.get("units");
  if (!units) return;
  static const std::vector<std::string> watts{"W m^-2", "W m-2", "W/m2"};
  static const std::vector<std::string> photons{"umol m^-2 s^-1", "umol m-2 s-1", "umol/m2/s"};
  for (std::size_t b = 0; b < scene.bands.size(); ++b) {
    const auto unit = units->get(scene.bands[b]);
    if (!unit) continue;
    std::vector<std::string> known = watts;
    known.insert(known.end(), photons.begin(), photons.end());
    const std::string text = unit->one_of(known);
    if (std::find(photons.begin(), photons.end(), text) != photons.end()) scene.band_units[b] = photons.front();
  }
}

void read_domain(const TomlValue& root, Scene& scene) {
  const auto domain = root.get("domain");
  if (!domain) return;
  const auto periodic = domain->need("periodic", "[xmin, ymin, xmax, ymax] of the cell that repeats [m]");
  const auto v = periodic.numbers(4, "xmin, ymin, xmax, ymax [m]");
  if (!(v[2] > v[0] && v[3] > v[1]))
    periodic.fail(fmt::format("[{}, {}, {}, {}]", v[0], v[1], v[2], v[3]), "xmax above xmin and ymax above ymin");
  scene.periodic = PeriodicCell{v[0], v[1], v[2], v[3]};
  if (const auto slope = domain->get("slope")) {
    const auto s = slope->numbers(2, "dz/dx, dz/dy, how the endless plane rises to the east and to the north [-]");
    if (!(std::hypot(s[0], s[1]) <= steepest_slope))
      slope->fail(fmt::format("[{}, {}], a slope of {:.2f} degrees", s[0], s[1],
                              std::atan(std::hypot(s[0], s[1])) * 180.0 / 3.14159265358979323846),
                  fmt::format("dz/dx and dz/dy of a slope of at most {:g} (84.29 degrees): an upright plane has no cell", steepest_slope));
    scene.periodic->slope_x = s[0], scene.periodic->slope_y = s[1];
  }
}

}  // namespace

std::vector<double> read_per_band(const TomlValue& table, const Scene& scene, const std::function<double(const TomlValue&)>& read) {
  if (!table.is_table()) table.fail("a value per band, like { " + scene.bands.front() + " = ... }");
  std::vector<double> values;
  for (const auto& band : scene.bands) values.push_back(read(table.need(band, "a number: every band needs one")));
  return values;
}

std::string read_path(const TomlValue& value, const Scene& scene, const std::string& expected) {
  namespace fs = std::filesystem;
  const fs::path path = (fs::path(scene.file).parent_path() / value.text()).lexically_normal();
  std::error_code error;
  if (fs::is_directory(path, error)) value.fail("a folder, \"" + path.string() + '"', expected);
  if (!fs::exists(path, error)) value.fail("no file \"" + path.string() + '"', expected + " (its path is relative to the scene file)");
  InputRecord::note(path.string());
  return path.string();
}

SceneFile read_scene_file(const std::string& file) {
  const TomlDocument document(file);
  const TomlValue root = document.root();
  document.check_keys(scene_schema(band_names_if_any(root)));
  SceneFile out;
  Scene& scene = out.scene;
  scene.file = file;
  scene.text = document.text();
  read_bands(root, scene);
  read_domain(root, scene);
  read_light(root, scene);
  read_output(root, out.output);
  read_solve(root, out.run);
  read_optics(root, scene);
  read_ground(root, scene);
  read_plants_and_groups(root, scene);
  read_lamps(root, scene);
  read_sensors(root, scene);
  check_scene(scene);
  for (auto& note : lay_on_slope(scene)) scene.notes.push_back(location(scene.file) + ": " + std::move(note));
  for (auto& note : notes_on_sizes(scene, scene_sizes(scene))) scene.notes.push_back(std::move(note));
  for (auto& note : notes_on_extent(scene)) scene.notes.push_back(std::move(note));
  return out;
}

Scene read_scene(const std::string& file) {
  return read_scene_file(file).scene;
}

}  // namespace sunfleck
