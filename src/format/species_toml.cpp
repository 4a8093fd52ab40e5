// The names, ranges and units of all species parameters stand in the tables below; docs/species.md explains them.
#include <sunfleck/format/species_toml.hpp>

#include <limits>
#include <variant>

#include <sunfleck/core/error.hpp>

#include <format/toml_value.hpp>

namespace sunfleck {

namespace {

/// One key: where its value goes, and what it may be. Keys left out keep the default of species.hpp.
template <class T>
struct Key {
  const char* name = "";
  std::variant<double T::*, std::int64_t T::*, std::string T::*, Outline T::*> member;
  double low = 0, high = 0;
  const char* unit = "";
};
template <class T>
using Keys = std::vector<Key<T>>;

const Keys<TreeGrowth> tree_keys{
    {"relay_angle", &TreeGrowth::relay_deg, 0, 90, "degrees"}, {"clear_trunk", &TreeGrowth::clear_trunk, 0, 0.9},
    {"highest_order", &TreeGrowth::highest_order, 1, 8},       {"merge_nodes", &TreeGrowth::merge_nodes, 1, 100},
    {"tip_radius", &TreeGrowth::tip_radius_m, 1e-4, 0.1, "m"}, {"pipe_exponent", &TreeGrowth::pipe_exponent, 1, 4},
    {"pipe_per_node", &TreeGrowth::pipe_per_node, 0, 10},
};

const Keys<LeafParameters> leaf_keys{
    {"length", &LeafParameters::length_m, 1e-3, 2, "m"},
    {"width_ratio", &LeafParameters::width_ratio, 0.01, 3},
    {"outline", &LeafParameters::outline},
    {"fold", &LeafParameters::fold_deg, 0, 80, "degrees"},
    {"curvature", &LeafParameters::curvature_deg, 0, 180, "degrees"},
    {"petiole_ratio", &LeafParameters::petiole_ratio, 0, 3},
    {"petiole_width_ratio", &LeafParameters::petiole_width_ratio, 1e-3, 0.5},
    {"hinge", &LeafParameters::hinge_deg, 0, 120, "degrees"},
    {"insertion", &LeafParameters::insertion_deg, 0, 150, "degrees"},
    {"insertion_spread", &LeafParameters::insertion_spread_deg, 0, 90, "degrees"},
    {"droop", &LeafParameters::droop_deg, 0, 90, "degrees"},
    {"uprightness", &LeafParameters::uprightness, 0, 1},
    {"size_spread", &LeafParameters::size_spread, 0, 0.9},
    {"life", &LeafParameters::life_years, 0.1, 20, "years"},
    {"leaflets_low", &LeafParameters::leaflets_low, 1, 61},
    {"leaflets_high", &LeafParameters::leaflets_high, 1, 61},
    {"rachis_length", &LeafParameters::rachis_length_m, 1e-3, 3, "m"},
    {"rachis_radius", &LeafParameters::rachis_radius_m, 1e-4, 0.05, "m"},
    {"rachis_curvature", &LeafParameters::rachis_curvature_deg, 0, 180, "degrees"},
    {"leaflet_angle", &LeafParameters::leaflet_angle_deg, 5, 120, "degrees"},
};

const Keys<AxisClass> axis_keys{
    {"nodes", &AxisClass::nodes, 0.5, 200},
    {"nodes_spread", &AxisClass::nodes_spread, 0, 0.9},
    {"internode_length", &AxisClass::internode_length_m, 1e-4, 1, "m"},
    {"decline", &AxisClass::decline, 0, 1},
    {"lifetime", &AxisClass::lifetime_years, 0.1, 1000, "years"},
    {"strong_branches", &AxisClass::strong_branches, 0, 50},
    {"strong_class", &AxisClass::strong_class, 1, 16},
    {"weak_probability", &AxisClass::weak_probability, 0, 1},
    {"acrotony", &AxisClass::acrotony, 0, 10},
    {"weak_class", &AxisClass::weak_class, 1, 16},
    {"basal_vigour", &AxisClass::basal_vigour, 0.01, 1},
    {"insertion", &AxisClass::insertion_deg, 0, 150, "degrees"},
    {"insertion_spread", &AxisClass::insertion_spread_deg, 0, 90, "degrees"},
    {"sag", &AxisClass::sag_deg, 0, 45, "degrees per year"},
    {"elevation", &AxisClass::elevation_deg, -90, 90, "degrees"},
    {"tropism", &AxisClass::tropism_deg, 0, 1000, "degrees per m"},
    {"wobble", &AxisClass::wobble_deg, 0, 45, "degrees"},
    {"divergence", &AxisClass::divergence_deg, 0, 360, "degrees"},
    {"leaf_scale", &AxisClass::leaf_scale, 0.05, 5},
    {"sides", &AxisClass::sides, 3, 24},
};

const Keys<CerealGrowth> development_keys{
    {"leaves", &CerealGrowth::leaves, 1, 60},
    {"leaves_spread", &CerealGrowth::leaves_spread, 0, 10},
    {"phyllochron", &CerealGrowth::phyllochron, 0.1, 100, "days"},
    {"expansion", &CerealGrowth::expansion, 0.1, 200, "days"},
    {"leaf_life", &CerealGrowth::leaf_life, 1, 1000, "days"},
};

const Keys<CerealGrowth> stem_keys{
    {"basal_nodes", &CerealGrowth::basal_nodes, 0, 60},
    {"basal_length", &CerealGrowth::basal_length_m, 1e-4, 0.5, "m"},
    {"upper_length", &CerealGrowth::upper_length_m, 1e-3, 1, "m"},
    {"elongation_start", &CerealGrowth::elongation_start, 0, 1000, "days"},
    {"peduncle_length", &CerealGrowth::peduncle_length_m, 0, 1, "m"},
    {"base_radius", &CerealGrowth::base_radius_m, 1e-4, 0.1, "m"},
    {"top_radius", &CerealGrowth::top_radius_m, 1e-4, 0.1, "m"},
    {"sides", &CerealGrowth::sides, 3, 24},
    {"lean", &CerealGrowth::lean_deg, 0, 45, "degrees"},
};

const Keys<CerealGrowth> blade_keys{
    {"length", &CerealGrowth::blade_length_m, 1e-3, 3, "m"},
    {"width", &CerealGrowth::blade_width_m, 1e-4, 0.5, "m"},
    {"longest_rank", &CerealGrowth::longest_rank, 0.05, 1},
    {"first_relative_length", &CerealGrowth::first_blade, 0.05, 1},
    {"last_relative_length", &CerealGrowth::last_blade, 0.05, 1},
    {"outline", &CerealGrowth::outline},
    {"segments", &CerealGrowth::segments, 2, 64},
    {"fold", &CerealGrowth::fold_deg, 0, 80, "degrees"},
    {"insertion_first", &CerealGrowth::insertion_first_deg, 0, 120, "degrees"},
    {"insertion_last", &CerealGrowth::insertion_last_deg, 0, 120, "degrees"},
    {"insertion_spread", &CerealGrowth::insertion_spread_deg, 0, 60, "degrees"},
    {"curvature_first", &CerealGrowth::curvature_first_deg, 0, 220, "degrees"},
    {"curvature_last", &CerealGrowth::curvature_last_deg, 0, 220, "degrees"},
    {"curvature_spread", &CerealGrowth::curvature_spread_deg, 0, 90, "degrees"},
    {"divergence", &CerealGrowth::divergence_deg, 0, 360, "degrees"},
    {"divergence_spread", &CerealGrowth::divergence_spread_deg, 0, 180, "degrees"},
};

const Keys<CerealGrowth> tiller_keys{
    {"count", &CerealGrowth::tillers, 0, 20},
    {"probability", &CerealGrowth::tiller_probability, 0, 1},
    {"delay", &CerealGrowth::tiller_delay, 0, 20, "phyllochrons"},
    {"angle", &CerealGrowth::tiller_deg, 0, 90, "degrees"},
    {"straightening", &CerealGrowth::tiller_straightening, 0, 1},
    {"relative_leaves", &CerealGrowth::tiller_leaves, 0.05, 1},
    {"relative_length", &CerealGrowth::tiller_scale, 0.05, 2},
    {"highest_order", &CerealGrowth::highest_order, 1, 5},
};

const Keys<Inflorescence> inflorescence_keys{
    {"type", &Inflorescence::type},
    {"rank", &Inflorescence::rank, 0, 1},
    {"appears", &Inflorescence::appears, 0, 1000, "days"},
    {"expansion", &Inflorescence::expansion, 0.1, 200, "days"},
    {"length", &Inflorescence::length_m, 1e-3, 2, "m"},
    {"radius", &Inflorescence::radius_m, 1e-4, 0.5, "m"},
    {"spikes", &Inflorescence::spikes, 1, 100},
    {"spread", &Inflorescence::spread_deg, 0, 120, "degrees"},
    {"insertion", &Inflorescence::insertion_deg, 0, 120, "degrees"},
    {"spikelets", &Inflorescence::spikelets, 0, 200},
    {"awn_length", &Inflorescence::awn_length_m, 0, 1, "m"},
};

template <class T>
TomlSchema schema_of(const Keys<T>& keys) {
  std::vector<std::string> names;
  for (const auto& key : keys) names.emplace_back(key.name);
  return TomlSchema::of(names);
}

TomlSchema tree_schema() {
  return TomlSchema::of({"name", "program", "ages", "age", "seed"},
                        {{"tree", schema_of(tree_keys)}, {"leaf", schema_of(leaf_keys)}, {"axis", schema_of(axis_keys)}});
}

TomlSchema cereal_schema() {
  return TomlSchema::of({"name", "program", "ages", "age", "seed"}, {{"development", schema_of(development_keys)},
                                                                     {"stem", schema_of(stem_keys)},
                                                                     {"blade", schema_of(blade_keys)},
                                                                     {"tillers", schema_of(tiller_keys)},
                                                                     {"inflorescence", schema_of(inflorescence_keys)}});
}

/// Positions rising from 0 to 1, half-widths from 0 to 1, never two zeros in a row (no area between them).
Outline outline(const TomlValue& value) {
  Outline points;
  const auto items = value.items();
  if (items.size() < 2) value.fail("at least two points [position, half-width]");
  for (const auto& item : items) {
    const auto pair = item.numbers(2, "position from 0 (base) to 1 (tip), half-width from 0 to 1");
    if (pair[1] < 0 || pair[1] > 1) item.fail("half-width " + std::to_string(pair[1]), "a half-width from 0 to 1");
    if (points.empty() ? pair[0] != 0 : !(pair[0] > points.back()[0]))
      item.fail("position " + std::to_string(pair[0]), points.empty() ? "0 for the first point" : "positions that rise");
    if (!points.empty() && points.back()[1] == 0 && pair[1] == 0)
      item.fail("two half-widths of zero in a row", "some width between any two points");
    points.push_back({pair[0], pair[1]});
  }
  if (points.back()[0] != 1) items.back().fail("position " + std::to_string(points.back()[0]), "1 for the last point");
  return points;
}

template <class T>
void read_into(T& target, const TomlValue& table, const Keys<T>& keys) {
  for (const auto& key : keys) {
    const auto value = table.get(key.name);
    if (!value) continue;
    if (const auto* d = std::get_if<double T::*>(&key.member))
      target.** d = value->number(key.low, key.high, key.unit);
    else if (const auto* i = std::get_if<std::int64_t T::*>(&key.member))
      target.** i = value->integer(static_cast<std::int64_t>(key.low), static_cast<std::int64_t>(key.high));
    else if (const auto* s = std::get_if<std::string T::*>(&key.member))
      target.** s = value->text();
    else
      target.*std::get<Outline T::*>(key.member) = outline(*value);
  }
}

template <class T>
void read_section(T& target, const TomlValue& root, const char* section, const Keys<T>& keys) {
  if (const auto table = root.get(section)) read_into(target, *table, keys);
}

TreeGrowth read_tree(const TomlValue& root) {
  TreeGrowth growth;
  read_section(growth, root, "tree", tree_keys);
  read_section(growth.leaf, root, "leaf", leaf_keys);
  const auto& leaf = growth.leaf;
  if (const auto table = root.get("leaf")) {
    if (leaf.leaflets_low % 2 == 0) table->need("leaflets_low", "").fail("an odd number: pairs and one at the end");
    if (leaf.leaflets_high % 2 == 0) table->need("leaflets_high", "").fail("an odd number: pairs and one at the end");
    if (leaf.leaflets_high < leaf.leaflets_low)
      throw InputError(table->where("leaflets_high"), std::to_string(leaf.leaflets_high),
                       "at least leaflets_low, " + std::to_string(leaf.leaflets_low));
    if (leaf.leaflets_low == 1 && leaf.leaflets_high > 1)
      throw InputError(table->where("leaflets_low"), "1", "at least 3 where leaves have leaflets");
  }
  const auto axes = root.need("axis", "[[axis]] tables, one for each physiological age, the trunk first").tables();
  if (axes.empty()) root.need("axis", "").fail("at least one [[axis]], the trunk");
  for (const auto& table : axes) {
    AxisClass axis;
    read_into(axis, table, axis_keys);
    const auto count = static_cast<std::int64_t>(axes.size());
    const std::string expected = "a physiological age from 1 to " + std::to_string(count) + ", the number of [[axis]] tables";
    if (axis.strong_branches > 0 && axis.strong_class > count)
      throw InputError(table.where("strong_class"), std::to_string(axis.strong_class), expected);
    if (axis.weak_probability > 0 && axis.weak_class > count)
      throw InputError(table.where("weak_class"), std::to_string(axis.weak_class), expected);
    growth.axes.push_back(axis);
  }
  return growth;
}

CerealGrowth read_cereal(const TomlValue& root) {
  CerealGrowth growth;
  read_section(growth, root, "development", development_keys);
  read_section(growth, root, "stem", stem_keys);
  read_section(growth, root, "blade", blade_keys);
  read_section(growth, root, "tillers", tiller_keys);
  if (const auto list = root.get("inflorescence"))
    for (const auto& table : list->tables()) {
      Inflorescence inflorescence;
      read_into(inflorescence, table, inflorescence_keys);
      growth.inflorescences.push_back(inflorescence);
    }
  return growth;
}

}  // namespace

bool is_species(const std::string& file) {
  return TomlDocument(file).root().has("program");
}

Species read_species(const std::string& file) {
  const TomlDocument document(file);
  const TomlValue root = document.root();
  Species species;
  species.file = file;
  const std::string program = root.need("program", "\"tree\" or \"cereal\"").one_of({"tree", "cereal"});
  document.check_keys(program == "tree" ? tree_schema() : cereal_schema());
  species.name = root.need("name", "the species' name").text();
  species.age_unit = program == "tree" ? "years" : "days";
  const double highest = program == "tree" ? 200 : 2000;
  const auto range = root.need("ages", "the lowest and the highest age [" + species.age_unit + "]");
  const auto ages = range.numbers(2, "lowest and highest age [" + species.age_unit + "]");
  if (!(ages[0] > 0 && ages[0] <= ages[1] && ages[1] <= highest))
    range.fail(std::to_string(ages[0]) + " to " + std::to_string(ages[1]),
               "two rising ages, above 0 and at most " + std::to_string(static_cast<int>(highest)) + " " + species.age_unit);
  species.age_low = ages[0];
  species.age_high = ages[1];
  species.age =
      root.need("age", "the age to grow to where none is asked for [" + species.age_unit + "]").number(ages[0], ages[1], species.age_unit);
  if (const auto seed = root.get("seed"))
    species.seed = static_cast<std::uint64_t>(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
  if (program == "tree")
    species.growth = read_tree(root);
  else
    species.growth = read_cereal(root);
  return species;
}

Plant read_species_plant(const std::string& file, std::optional<double> age, std::optional<std::uint64_t> seed) {
  const Species species = read_species(file);
  return grow(species, age.value_or(species.age), seed.value_or(species.seed));
}

}  // namespace sunfleck
