// [[plant]], [[group]] and [[place]].
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/scene/build.hpp>

#include <format/scene_toml_parts.hpp>

namespace sunfleck {

namespace {

/// What makes a plant: its file and unit, or its species, age and seed.
using PlantKey = std::tuple<std::string, double, std::optional<double>, std::optional<std::int64_t>>;
/// A plant that several entries name is read or grown once.
using PlantCache = std::map<PlantKey, std::shared_ptr<const Plant>>;

std::shared_ptr<const Plant> read_shared(const TomlValue& table, Scene& scene, PlantCache& cache) {
  const std::string file = read_path(table.need("file", "the plant's file"), scene, "a plant file");
  const bool is_species = std::filesystem::path(file).extension() == ".toml";
  const auto age = table.get("age"), seed = table.get("seed"), unit = table.get("unit");
  if (is_species && unit) unit->fail("`unit` beside a species", "none: species grow in metres");
  if (!is_species && (age || seed))
    (age ? age : seed)->fail(fmt::format("`{}` beside a file that is no species .toml", age ? "age" : "seed"), "it with species only");
  std::error_code circle;  // of links: the reader says so
  const auto canonical = std::filesystem::weakly_canonical(file, circle);
  PlantKey key{circle ? file : canonical.string(), read_unit(table), {}, {}};
  if (age) std::get<2>(key) = age->positive();
  if (seed) std::get<3>(key) = seed->integer(0, std::numeric_limits<std::int64_t>::max());
  auto& plant = cache[key];
  if (!plant) {
    auto read = is_species ? read_species_plant(file, std::get<2>(key), std::get<3>(key)) : read_plant(file, std::get<1>(key));
    check_plant(read);
    scene.notes.insert(scene.notes.end(), read.notes.begin(), read.notes.end());
    plant = std::make_shared<const Plant>(std::move(read));
  }
  return plant;
}

std::string listed(const std::map<std::string, std::string>& missing) {
  constexpr std::size_t most = 6;
  std::string text;
  std::size_t shown = 0;
  for (const auto& [what, example] : missing) {
    if (shown++ == most) return text + fmt::format("; and {} more", missing.size() - most);
    text += (text.empty() ? "" : "; ") + what + (example.empty() ? "" : fmt::format(" (such as \"{}\")", example));
  }
  return text;
}

std::vector<std::string> optics_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& optics : scene.optics) names.push_back(optics.name);
  return names;
}

/// Optics of every shape: by the name of its structure, "type/material", the structure's type, its material, or "*", in this order.
class OpticsMap {
 public:
  OpticsMap(const TomlValue& table, const Scene& scene) : table_(table) {
    const auto known = optics_names(scene);
    for (const auto& [key, value] : table.members()) {
      std::string name = value.text();
      const auto at = std::find(known.begin(), known.end(), name);
      if (at == known.end()) {
        const std::string nearest = nearest_name(name, known);
        value.fail(known.empty() ? "an optics name: the scene has no [optics.NAME]"
                                 : "one of " + joined(known) + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
      }
      entries_.emplace(key, Entry{value, static_cast<std::uint32_t>(at - known.begin())});
    }
    if (const auto at = entries_.find("*"); at != entries_.end()) rest_ = &at->second;
  }

  std::vector<std::uint32_t> of_shapes(const Plant& plant, Scene& scene) {
    std::vector<std::uint32_t> rows;
    std::map<std::string, std::string> missing;  // type and material -> the first structure of them
    std::set<std::string> names, pairs;
    for (const auto& shape : plant.shapes) {
      const auto& structure = plant.structures[shape.structure];
      const std::string& type = plant.types[structure.type];
      const std::string& material = plant.materials[shape.material];
      names.insert({structure.name, type, material});
      const std::string pair = material.empty() ? std::string{} : type + "/" + material;
      if (!pair.empty()) pairs.insert(pair);
      const Entry* entry = nullptr;
      for (const auto* name : {&structure.name, &pair, &type, &material})
        if (!entry) entry = named(*name);
      if (!entry) entry = rest_;
      if (entry) {
        rows.push_back(entry->row);
      } else {
        const std::string what = fmt::format("type \"{}\"", type) + (material.empty() ? "" : fmt::format(", material \"{}\"", material));
        missing.try_emplace(what, structure.name);
      }
    }
    if (!missing.empty())
      table_.fail("no optics for " + listed(missing), "a key that is the type, material or name of each, or \"*\" for the rest");
    refuse_misspelt(plant, names, pairs, scene);
    return rows;
  }

 private:
  struct Entry {
    TomlValue value;
    std::uint32_t row;
  };

  const Entry* named(const std::string& name) const {
    const auto at = name.empty() ? entries_.end() : entries_.find(name);
    return at == entries_.end() ? nullptr : &at->second;
  }

  /// A key that names nothing in the plant is an error if it looks like a misspelt name that no key names, else worth a note.
  void refuse_misspelt(const Plant& plant, const std::set<std::string>& names, const std::set<std::string>& pairs, Scene& scene) const {
    std::vector<std::string> unnamed;
    for (const auto& name : names)
      if (!name.empty() && !entries_.count(name)) unnamed.push_back(name);
    for (const auto& [key, entry] : entries_) {
      if (key == "*" || names.count(key) || pairs.count(key)) continue;
      const std::string what = fmt::format("a key that is no structure name, type or material of {}", plant.file);
      const std::string nearest = nearest_name(key, unnamed);
      if (!nearest.empty()) entry.value.fail(what, "one that is; did you mean \"" + nearest + "\"?");
      scene.notes.push_back(entry.value.where() + ": " + what);
    }
  }

  TomlValue table_;
  std::map<std::string, Entry> entries_;
  const Entry* rest_ = nullptr;
};

/// Names of plants and groups, and which of them something places.
class Names {
 public:
  struct Target {
    bool is_group;
    std::uint32_t index;
  };

  std::string add(const TomlValue& table, bool is_group, std::size_t index) {
    const auto value = table.need("name", "a name");
    const std::string name = value.text();
    if (name.find('/') != std::string::npos) value.fail("a name without \"/\", which separates the parts of a placement's path");
    if (!targets_.emplace(name, Target{is_group, static_cast<std::uint32_t>(index)}).second)
      value.fail(fmt::format("\"{}\" twice", name), "a name of its own for every plant and group");
    return name;
  }

  /// What `plant = "..."` or `group = "..."` of an entry names.
  Target find(const TomlValue& entry) {
    const auto plant = entry.get("plant"), group = entry.get("group");
    if (plant.has_value() == group.has_value())
      throw InputError(entry.where(), plant ? "both `plant` and `group`" : "neither `plant` nor `group`", "one of them");
    const auto& value = plant ? *plant : *group;
    const std::string name = value.text(), kind = plant ? "plant" : "group";
    const auto at = targets_.find(name);
    if (at == targets_.end() || at->second.is_group != group.has_value()) {
      std::vector<std::string> known;
      for (const auto& [other, target] : targets_)
        if (target.is_group == group.has_value()) known.push_back(other);
      const std::string nearest = nearest_name(name, known);
      value.fail(known.empty() ? fmt::format("a {}: the scene has none", kind)
                               : fmt::format("one of {}{}", joined(known), nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
    }
    used_.insert(name);
    return at->second;
  }

  bool used(const std::string& name) const { return used_.count(name) > 0; }

 private:
  std::map<std::string, Target> targets_;
  std::set<std::string> used_;
};

void append(std::vector<Placement>& all, std::vector<Placement> more) {
  if (all.empty())
    all = std::move(more);
  else
    all.insert(all.end(), more.begin(), more.end());
}

void read_plant_entries(const TomlValue& plants, Scene& scene, Names& names) {
  PlantCache cache;
  for (const auto& table : plants.tables()) {
    PlantEntry entry;
    entry.name = names.add(table, false, scene.plants.size());
    entry.plant = read_shared(table, scene, cache);
    entry.shape_optics = OpticsMap(table.need("optics", "which optics its organs have, like { Leaf = \"leaf\", \"*\" = \"bark\" }"), scene)
                             .of_shapes(*entry.plant, scene);
    if (const auto policy = table.get("policy")) entry.policy_file = read_path(*policy, scene, "a policy file");
    if (const auto place = table.get("place"))
      for (const auto& one : place->tables()) append(entry.placements, read_placements(one, scene));
    if (table.has("grid")) {  // short for place = [ { grid = ... } ]
      if (table.has("place")) table.get("grid")->fail("`grid` beside `place`", "one of them");
      append(entry.placements, read_grid(*table.get("grid")));
    }
    scene.plants.push_back(std::move(entry));
  }
}

void read_group_members(const TomlValue& table, Scene& scene, Names& names, GroupEntry& group) {
  const auto place = table.need("place", "its members, like [ { plant = \"NAME\", position = [0, 0, 0] } ]");
  for (const auto& entry : place.tables()) {
    const auto target = names.find(entry);
    for (const auto& placement : read_placements(entry, scene)) group.members.push_back({target.is_group, target.index, placement});
  }
  if (group.members.empty()) place.fail("at least one member");
}

void refuse_cycle(const std::vector<TomlValue>& tables, const Scene& scene) {
  const auto cycle = group_cycle(scene);
  if (cycle.empty()) return;
  std::string text;
  for (const auto g : cycle) text += (text.empty() ? "\"" : " -> \"") + scene.groups[g].name + '"';
  tables[cycle.front()].fail("a group that holds itself: " + text, "groups without a circle");
}

void note_unplaced(Scene& scene, const Names& names) {
  const auto note = [&](const std::string& kind, const std::string& name) {
    scene.notes.push_back(fmt::format("{}: {} \"{}\" is placed nowhere: it has no part in the scene", scene.file, kind, name));
  };
  for (const auto& plant : scene.plants)
    if (plant.placements.empty() && !names.used(plant.name)) note("plant", plant.name);
  for (const auto& group : scene.groups)
    if (group.placements.empty() && !names.used(group.name)) note("group", group.name);
}

}  // namespace

TomlSchema plant_schema() {
  return TomlSchema::of({"name", "file", "unit", "age", "seed", "policy"},
                        {{"optics", TomlSchema::names(TomlSchema::leaf())}, {"place", placement_schema({})}, {"grid", grid_schema()}});
}

TomlSchema group_schema() {
  return TomlSchema::of({"name"}, {{"place", placement_schema({"plant", "group"})}});
}

double read_unit(const TomlValue& owner) {
  static const std::vector<std::pair<std::string, double>> units{
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}};
  const auto unit = owner.get("unit");
  if (!unit) return 1.0;
  std::vector<std::string> names;
  for (const auto& u : units) names.push_back(u.first);
  const std::string name = unit->one_of(names);
  return std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == name; })->second;
}

void read_plants_and_groups(const TomlValue& root, Scene& scene) {
  Names names;
  if (const auto plants = root.get("plant")) read_plant_entries(*plants, scene, names);
  if (const auto groups = root.get("group")) {
    const auto tables = groups->tables();
    for (const auto& table : tables) {  // names first: a group may hold one that comes later
      scene.groups.emplace_back();
      scene.groups.back().name = names.add(table, true, scene.groups.size() - 1);
    }
    for (std::size_t g = 0; g < tables.size(); ++g) read_group_members(tables[g], scene, names, scene.groups[g]);
    refuse_cycle(tables, scene);
  }
  if (const auto place = root.get("place"))
    for (const auto& entry : place->tables()) {
      const auto target = names.find(entry);
      append(target.is_group ? scene.groups[target.index].placements : scene.plants[target.index].placements,
             read_placements(entry, scene));
    }
  note_unplaced(scene, names);
}

}  // namespace sunfleck
