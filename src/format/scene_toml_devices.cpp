// [[lamp]] and [[sensor]].
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/format/ies.hpp>
#include <sunfleck/scene/build.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

double strength_value(const TomlValue& value) {
  return value.up_to(brightest);
}

Vec3 vector(const TomlValue& value, const char* names) {
  const auto v = value.numbers(3, names);
  return {v[0], v[1], v[2]};
}

/// position, aim and turn of one photometric lamp.
Placement aimed(const TomlValue& table) {
  Vec3 aim{0.0, 0.0, -1.0};
  if (const auto value = table.get("aim")) {
    aim = vector(*value, "x, y, z of the direction of the lamp's nadir");
    const double largest = std::max({std::abs(aim.x), std::abs(aim.y), std::abs(aim.z)});
    if (largest == 0) value->fail("[0, 0, 0]", "a vector that is not zero");
    aim = glm::normalize(aim / largest);
  }
  // the shortest turn that takes straight down to the aim; upside down, a half turn about x
  const Vec3 down{0.0, 0.0, -1.0}, axis = glm::cross(down, aim);
  const double c = glm::dot(down, aim);
  Mat3 turn{1.0};
  if (c < -1.0 + 1e-12) {
    turn = Mat3{Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1}};
  } else {
    const Mat3 k{Vec3{0, axis.z, -axis.y}, Vec3{-axis.z, 0, axis.x}, Vec3{axis.y, -axis.x, 0}};
    turn = Mat3{1.0} + k + (1.0 / (1.0 + c)) * (k * k);
  }
  Affine about = Affine::turn(0.0);
  if (const auto value = table.get("turn")) about = Affine::turn(value->number() * 3.14159265358979323846 / 180.0);
  return {{turn * about.linear, vector(table.need("position", "[x, y, z] [m], or `place`, or `grid`"), "x, y, z [m]")}};
}

std::vector<Placement> lamp_placements(const TomlValue& table, const Scene& scene, bool photometric) {
  const auto place = table.get("place"), grid = table.get("grid"), position = table.get("position"), aim = table.get("aim"),
             turn = table.get("turn");
  if (place && grid) grid->fail("`grid` beside `place`", "one of them");
  if (!photometric)
    for (const auto* value : {&position, &aim, &turn})
      if (*value)
        (*value)->fail("`position`, `aim` or `turn` beside `mesh`", "`place` or `grid`: a mesh stands as its file says, or there");
  if (place || grid) {
    for (const auto* value : {&position, &aim, &turn})
      if (*value) (*value)->fail("`position`, `aim` or `turn` beside `place` or `grid`", "them inside");
    if (grid) return read_grid(*grid);
    std::vector<Placement> all;
    for (const auto& one : place->tables())
      for (const auto& placement : read_placements(one, scene)) all.push_back(placement);
    if (all.empty()) place->fail("at least one place");
    return all;
  }
  return {photometric ? aimed(table) : Placement{}};
}

void read_lamp_strength(const TomlValue& table, const Scene& scene, LampEntry& lamp) {
  const auto exitance = table.get("exitance"), power = table.get("power");
  if (lamp.photometry && exitance)
    exitance->fail("`exitance` beside `ies`", "`power` per band: a photometric file says where light goes, not how much");
  if (exitance.has_value() == power.has_value())
    throw InputError(table.where(),
                     exitance          ? "both `exitance` and `power`"
                     : lamp.photometry ? "no `power`"
                                       : "neither `exitance` nor `power`",
                     lamp.photometry ? "the power that the lamp gives off per band" : "one of them per band");
  lamp.by_power = power.has_value();
  lamp.strength = read_per_band(exitance ? *exitance : *power, scene, strength_value);
}

void read_lamp_states(const TomlValue& table, const Scene& scene, LampEntry& lamp) {
  const auto states = table.get("states");
  if (!states) return;
  std::vector<std::string> known;
  for (const auto& state : scene.states) known.push_back(state.name);
  if (!states->is_array()) states->fail("an array of names of states");
  for (const auto& item : states->items()) {
    const std::string name = item.text();
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      if (known.size() == 1 && known.front().empty()) item.fail("no `states`: the scene lists no [[state]]");
      const std::string nearest = nearest_name(name, known);
      item.fail("one of " + joined(known) + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
    }
    lamp.states.push_back(static_cast<std::uint32_t>(at - known.begin()));
  }
  if (lamp.states.empty()) states->fail("at least one state; leave `states` out for all");
}

/// A lamp whose every face looks up is most likely wound the wrong way round.
void note_upward(const TomlValue& table, const LampEntry& lamp, Scene& scene) {
  double up = 0.0, down = 0.0;
  for (const auto& placement : lamp.placements)
    for (std::size_t t = 0; t < lamp.mesh.triangles.size(); ++t) {
      Triangle c = lamp.mesh.corners(t);
      for (auto& p : c) p = placement.map.point(p);
      const double z = area_vector(c).z * (placement.map.mirrors() ? -1.0 : 1.0);
      (z > 0.0 ? up : down) += std::abs(z);
    }
  if (up > 0.0 && down <= 1e-6 * up)
    scene.notes.push_back(fmt::format(
        "{}: no face of this lamp looks down: faces shine from the side from which their corners run counter-clockwise", table.where()));
}

std::optional<std::array<double, 2>> pair(const TomlValue& owner, const char* key, const char* names, bool positive) {
  const auto value = owner.get(key);
  if (!value) return std::nullopt;
  const auto v = value->numbers(2, names);
  if (positive && !(v[0] > 0 && v[1] > 0)) value->fail(fmt::format("[{}, {}]", v[0], v[1]), "two lengths above zero [m]");
  return std::array<double, 2>{v[0], v[1]};
}

SensorGrid read_sensor_grid(const TomlValue& table) {
  SensorGrid grid;
  grid.z = table.need("z", "the height of the sensors [m]").number();
  const auto cells = table.need("cells", "[cells along x, cells along y]");
  const auto items = cells.is_array() ? cells.items() : std::vector<TomlValue>{};
  if (items.size() != 2) cells.fail("an array of 2 whole numbers: cells along x, cells along y");
  for (std::size_t i = 0; i < 2; ++i) grid.cells[i] = static_cast<std::uint32_t>(items[i].integer(1, 30000));
  grid.size = pair(table, "size", "along x, along y [m]", true);
  grid.centre = pair(table, "center", "x, y [m]", false);
  return grid;
}

SensorProfile read_profile(const TomlValue& table) {
  SensorProfile profile;
  profile.step = table.need("step", "the distance between heights [m]").positive("metres");
  if (const auto low = table.get("low")) profile.low = low->number();
  if (const auto high = table.get("high")) profile.high = high->number();
  if (profile.low && profile.high && !(*profile.high >= *profile.low))
    table.get("high")->fail(fmt::format("{}, below `low`", *profile.high), "a height not below `low` [m]");
  profile.size = pair(table, "size", "along x, along y [m]", true);
  profile.centre = pair(table, "center", "x, y [m]", false);
  return profile;
}

SensorEntry read_sensor(const TomlValue& table, Scene& scene, const Mesh* given) {
  SensorEntry sensor;
  sensor.name = table.need("name", "a name, under which the result keeps it").text();
  const auto grid = table.get("grid"), mesh = table.get("mesh"), profile = table.get("profile"), unit = table.get("unit");
  if (grid.has_value() + (mesh || given) + profile.has_value() != 1)
    throw InputError(table.where(), grid || mesh || profile ? "several shapes" : "no shape", "one of `grid`, `mesh` and `profile`");
  if (unit && !mesh) unit->fail("`unit` without `mesh`", "no unit: lengths of the scene are metres");
  if (grid) sensor.shape = read_sensor_grid(*grid);
  if (profile) sensor.shape = read_profile(*profile);
  if (mesh) sensor.shape = read_flat_mesh(read_path(*mesh, scene, "a mesh file"), read_unit(table), scene.notes);
  if (given) sensor.shape = *given;
  sensor.both_sides = profile.has_value();
  if (const auto sides = table.get("sides")) {
    if (profile) sides->fail("`sides` of a profile", "no `sides`: it has both");
    sensor.both_sides = sides->one_of({"front", "both"}) == "both";
  }
  if (const auto samples = table.get("samples")) sensor.samples = static_cast<std::uint32_t>(samples->integer(1, 1 << 24));
  return sensor;
}

}  // namespace

TomlSchema lamp_schema(const TomlSchema& per_band) {
  return TomlSchema::of({"name", "mesh", "unit", "ies", "position", "aim", "turn", "states"},
                        {{"exitance", per_band}, {"power", per_band}, {"place", placement_schema({})}, {"grid", grid_schema()}});
}

TomlSchema sensor_schema() {
  return TomlSchema::of(
      {"name", "mesh", "unit", "sides", "samples"},
      {{"grid", TomlSchema::of({"z", "cells", "size", "center"})}, {"profile", TomlSchema::of({"step", "low", "high", "size", "center"})}});
}

void read_lamps(const TomlValue& root, Scene& scene, const Mesh* given) {
  const auto lamps = root.get("lamp");
  if (!lamps) return;
  for (const auto& table : lamps->tables()) {
    LampEntry lamp;
    lamp.name = fmt::format("lamp {}", scene.lamps.size() + 1);
    if (const auto name = table.get("name")) lamp.name = name->text();
    const auto mesh = table.get("mesh"), ies = table.get("ies"), unit = table.get("unit");
    const bool has_mesh = mesh || given;
    if (has_mesh == ies.has_value())
      throw InputError(table.where(), has_mesh ? "both `mesh` and `ies`" : "neither `mesh` nor `ies`", "one of them");
    if (unit && !mesh) unit->fail("`unit` without `mesh`", "no unit: a photometric file has its own");
    if (ies)
      lamp.photometry = std::make_shared<const Photometry>(read_ies(read_path(*ies, scene, "a photometric file (IES LM-63)")));
    else
      lamp.mesh = given ? *given : read_flat_mesh(read_path(*mesh, scene, "a mesh file"), read_unit(table), scene.notes);
    read_lamp_strength(table, scene, lamp);
    lamp.placements = lamp_placements(table, scene, ies.has_value());
    read_lamp_states(table, scene, lamp);
    if (has_mesh) note_upward(table, lamp, scene);
    scene.lamps.push_back(std::move(lamp));
  }
}

void read_sensors(const TomlValue& root, Scene& scene, const Mesh* given) {
  const auto sensors = root.get("sensor");
  if (!sensors) return;
  for (const auto& table : sensors->tables()) {
    scene.sensors.push_back(read_sensor(table, scene, given));
    for (std::size_t i = 0; i + 1 < scene.sensors.size(); ++i)
      if (scene.sensors[i].name == scene.sensors.back().name)
        table.get("name")->fail(fmt::format("\"{}\" twice", scene.sensors.back().name), "a name of its own for every sensor");
  }
}

}  // namespace sunfleck
