#include <sunfleck/format/scene_parts.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

/// What the readers of parts look at beside their own text.
Scene surroundings_of(const Scene& scene) {
  Scene out;
  out.file = scene.file;
  out.bands = scene.bands;
  out.band_units = scene.band_units;
  out.periodic = scene.periodic;
  out.states = scene.states;
  out.optics = scene.optics;
  return out;
}

template <class Entry>
bool has_name(const std::vector<Entry>& entries, const std::string& name) {
  return std::any_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
}

void refuse_second(const Scene& scene, const std::string& kind, const std::string& name) {
  throw InputError(location(scene.file, 0, kind + ".name"), fmt::format("\"{}\" twice", name), "a name of its own for every " + kind);
}

}  // namespace

std::vector<std::string> replace_light(Scene& scene, const std::string& text) {
  const TomlDocument document(text, "");
  const TomlSchema per_band = TomlSchema::of(scene.bands);
  const TomlSchema sun = sun_schema(per_band), sky = sky_schema(per_band), global = global_schema(per_band);
  document.check_keys(
      TomlSchema::of({}, {{"sun", sun},
                          {"sky", sky},
                          {"global", global},
                          {"state", TomlSchema::of({"name", "duration_s"}, {{"sun", sun}, {"sky", sky}, {"global", global}})}}));
  Scene read = surroundings_of(scene);
  read.states.clear();
  read_light(document.root(), read);
  scene.states = std::move(read.states);
  return std::move(read.notes);
}

std::vector<std::string> add_optics(Scene& scene, const std::string& text, bool replace) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"optics", TomlSchema::names(optics_schema(TomlSchema::of(scene.bands)))}}));
  Scene read = surroundings_of(scene);
  read.optics.clear();
  read_optics(document.root(), read);
  for (auto& optics : read.optics) {
    const auto at = std::find_if(scene.optics.begin(), scene.optics.end(), [&](const Optics& o) { return o.name == optics.name; });
    if (at == scene.optics.end())
      scene.optics.push_back(std::move(optics));
    else if (replace)
      *at = std::move(optics);
    else
      refuse_second(scene, "optics", optics.name);
  }
  return std::move(read.notes);
}

std::vector<std::string> replace_ground(Scene& scene, const std::string& text, const Mesh* mesh) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"ground", ground_schema(TomlSchema::of(scene.bands))}}));
  Scene read = surroundings_of(scene);
  read_ground(document.root(), read, mesh);
  scene.ground = std::move(read.ground);
  return std::move(read.notes);
}

std::vector<std::string> add_plant(Scene& scene, const std::string& text) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"plant", plant_schema()}}));
  Scene read = surroundings_of(scene);
  read_plants_and_groups(document.root(), read);
  for (auto& plant : read.plants) {
    if (has_name(scene.plants, plant.name) || has_name(scene.groups, plant.name)) refuse_second(scene, "plant", plant.name);
    scene.plants.push_back(std::move(plant));
  }
  read.notes.erase(std::remove_if(read.notes.begin(), read.notes.end(),
                                  [](const std::string& note) { return note.find("is placed nowhere") != std::string::npos; }),
                   read.notes.end());
  return std::move(read.notes);
}

std::vector<std::string> add_lamp(Scene& scene, const std::string& text, const Mesh* mesh) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"lamp", lamp_schema(TomlSchema::of(scene.bands))}}));
  Scene read = surroundings_of(scene);
  read_lamps(document.root(), read, mesh);
  for (auto& lamp : read.lamps) {
    if (has_name(scene.lamps, lamp.name)) refuse_second(scene, "lamp", lamp.name);
    scene.lamps.push_back(std::move(lamp));
  }
  return std::move(read.notes);
}

std::vector<std::string> add_sensor(Scene& scene, const std::string& text, const Mesh* mesh) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"sensor", sensor_schema()}}));
  Scene read = surroundings_of(scene);
  read_sensors(document.root(), read, mesh);
  for (auto& sensor : read.sensors) {
    if (has_name(scene.sensors, sensor.name)) refuse_second(scene, "sensor", sensor.name);
    scene.sensors.push_back(std::move(sensor));
  }
  return std::move(read.notes);
}

std::vector<Placement> read_places(const Scene& scene, const std::string& text) {
  const TomlDocument document(text, "");
  document.check_keys(TomlSchema::of({}, {{"place", placement_schema({})}}));
  std::vector<Placement> all;
  for (const auto& entry : document.root().need("place", "an array of places").tables())
    for (const auto& placement : read_placements(entry, scene)) all.push_back(placement);
  return all;
}

}  // namespace sunfleck
