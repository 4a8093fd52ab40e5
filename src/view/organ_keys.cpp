#include "view/organ_keys.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/plant/describe.hpp>

namespace sunfleck {

GroupKey key_of(const std::string& word) {
  static const std::map<std::string, GroupKeyKind> known{{"plant", GroupKeyKind::plant}, {"placement", GroupKeyKind::placement},
                                                         {"type", GroupKeyKind::type},   {"name", GroupKeyKind::name},
                                                         {"order", GroupKeyKind::order}, {"layer", GroupKeyKind::layer}};
  const auto at = known.find(word);
  if (at != known.end()) return {word, at->second, 0};
  if (word.rfind("layer:", 0) == 0) {
    double depth = 0;
    const char *begin = word.data() + 6, *end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(begin, end, depth);
    if (error != std::errc{} || rest != end || !(depth > 0) || !std::isfinite(depth))
      throw UsageError(fmt::format("--by: found '{}'; expected a depth above zero in metres, such as 'layer:0.5'", word));
    return {"layer", GroupKeyKind::layer, depth};
  }
  if (word.empty()) throw UsageError("--by: found an empty name; expected plant, type, layer, order or an attribute, separated by commas");
  return {word, GroupKeyKind::attribute, 0};
}

std::uint32_t KeyTable::row(double number) {
  return add({Value::number_kind, number, {}}, fmt::format("{}", number));
}
std::uint32_t KeyTable::row(const std::string& text) {
  return add({Value::text_kind, 0, text}, "\"" + text);
}
std::uint32_t KeyTable::row_of_nothing() {
  return add({}, "");
}

std::uint32_t KeyTable::row(const AttributeValue& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return row(std::string(*truth ? "true" : "false"));
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return row(static_cast<double>(*whole));
  if (const auto* number = std::get_if<double>(&value)) return row(*number);
  return row(std::get<std::string>(value));
}

std::string KeyTable::text(std::uint32_t row) const {
  const auto& v = values_[row];
  return v.kind == Value::number_kind ? fmt::format("{}", v.number) : csv_field(v.text);
}

std::vector<std::uint32_t> KeyTable::order() const {
  std::vector<std::uint32_t> rows(values_.size()), place(values_.size());
  std::iota(rows.begin(), rows.end(), 0u);
  std::stable_sort(rows.begin(), rows.end(), [&](auto a, auto b) {
    const auto &x = values_[a], &y = values_[b];
    return x.kind != y.kind ? x.kind < y.kind : x.kind == Value::number_kind && x.number < y.number;
  });
  for (std::uint32_t i = 0; i < rows.size(); ++i) place[rows[i]] = i;
  return place;
}

std::uint32_t KeyTable::add(Value value, const std::string& code) {
  const auto [at, added] = known_.try_emplace(code, static_cast<std::uint32_t>(values_.size()));
  if (added) values_.push_back(std::move(value));
  return at->second;
}

namespace {

[[noreturn]] void refuse(const std::string& name, const ResultGeometry& geometry) {
  std::vector<std::string> known{"plant", "placement", "type", "name", "layer", "order"};
  for (const auto& entry : geometry.plants)
    for (const auto& attribute : entry.plant->attribute_names)
      if (std::find(known.begin(), known.end(), attribute) == known.end()) known.push_back(attribute);
  const std::string nearest = nearest_name(name, known);
  throw UsageError(fmt::format("--by: found '{}'; expected one of {}{}", name, joined(known),
                               nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

}  // namespace

OrganKeys::OrganKeys(const Result& result, const std::vector<GroupKey>& keys)
    : file_(result.file()), keys_(keys), names_(result), tables_(keys.size()) {
  const bool structures = std::any_of(keys.begin(), keys.end(),
                                      [](const GroupKey& k) { return k.kind == GroupKeyKind::order || k.kind == GroupKeyKind::attribute; });
  if (structures) find_structures(result);
}

std::vector<std::uint32_t> OrganKeys::rows(std::size_t key, const OrganBlock& organs) {
  std::vector<std::uint32_t> out(organs.count);
  for (std::size_t i = 0; i < organs.count; ++i) out[i] = row(key, organs, i);
  return out;
}

std::uint32_t OrganKeys::row(std::size_t key, const OrganBlock& organs, std::size_t i) {
  const auto named = [&](std::uint32_t at, const std::vector<std::string>& texts) {
    auto& cache = named_[key];
    if (cache.empty()) cache.assign(texts.size(), no_parent);
    if (cache[at] == no_parent) cache[at] = tables_[key].row(texts[at]);
    return cache[at];
  };
  switch (keys_[key].kind) {
    case GroupKeyKind::plant:
      return named(organs.plant[i], names_.plants);
    case GroupKeyKind::placement:
      return named(organs.placement[i], names_.placements);
    case GroupKeyKind::type:
      return named(organs.type[i], names_.types);
    case GroupKeyKind::name:
      return named(organs.name[i], names_.names);
    default:
      break;
  }
  const auto entry = entry_of_plant_[organs.plant[i]];
  if (organs.structure[i] == no_parent || entry == no_parent) return tables_[key].row_of_nothing();
  const auto& rows = of_structure_[key][entry];
  if (organs.structure[i] >= rows.size())
    throw InputError(location(file_, 0, "/organs/structure"), "row " + std::to_string(organs.structure[i]),
                     "a row below " + std::to_string(rows.size()));
  return rows[organs.structure[i]];
}

void OrganKeys::find_structures(const Result& result) {
  const ResultGeometry geometry = result.geometry();
  entry_of_plant_.assign(names_.plants.size(), no_parent);
  for (std::size_t p = 0; p < names_.plants.size(); ++p)
    for (std::uint32_t e = 0; e < geometry.plants.size(); ++e)
      if (geometry.plants[e].name == names_.plants[p]) entry_of_plant_[p] = e;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const bool order = keys_[k].kind == GroupKeyKind::order;
    if (!order && keys_[k].kind != GroupKeyKind::attribute) continue;
    bool found = order;
    for (const auto& entry : geometry.plants) {
      const Plant& plant = *entry.plant;
      auto& rows = of_structure_[k].emplace_back(plant.structures.size());
      for (std::uint32_t s = 0; s < plant.structures.size(); ++s) {
        const auto* value = plant.attribute(s, keys_[k].name);
        const auto parent = plant.structures[s].parent;
        found = found || value;
        if (value)
          rows[s] = tables_[k].row(*value);
        else if (order)
          rows[s] = tables_[k].row(static_cast<double>(branching_order(plant, s)));
        else
          rows[s] = parent == no_parent ? tables_[k].row_of_nothing() : rows[parent];
      }
    }
    if (!found) refuse(keys_[k].name, geometry);
  }
}

}  // namespace sunfleck
