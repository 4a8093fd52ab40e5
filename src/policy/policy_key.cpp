#include "policy/policy_key.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

#include "policy/parameters.hpp"

namespace sunfleck {

namespace {

std::string where_of(const Policy& policy, const PolicyType& entry, long line, const std::string& key) {
  return location(policy.file.empty() ? "policy" : policy.file, line, "type." + entry.type + (key.empty() ? "" : "." + key));
}

std::string text_of(const Interval& i) {
  return std::isinf(i.high) ? fmt::format("[{}, ...)", i.low) : fmt::format("[{}, {})", i.low, i.high);
}

/// "leaf_count [4, 16)", or nothing if the value is outside.
std::optional<std::string> bin_of(const Policy& policy, const PolicyType& entry, const PolicyParameter& parameter,
                                  const ParameterValue& value) {
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw InputError(where_of(policy, entry, parameter.line, "parameters." + parameter.name), found, expected);
  };
  if (parameter.each) {
    if (value.number && !value.whole)
      refuse(fmt::format("\"each\" for a parameter with fractions such as {:.6g}", *value.number), "bounds or intervals");
    return parameter.name + " " + (value.number ? fmt::format("{}", *value.number) : value.text);
  }
  if (!parameter.values.empty()) {
    if (value.number)
      refuse(fmt::format("a list of texts for a parameter that holds numbers such as {:.6g}", *value.number), "bounds or intervals");
    const auto& values = parameter.values;
    if (std::find(values.begin(), values.end(), value.text) == values.end()) return {};
    return parameter.name + " " + value.text;
  }
  if (!value.number)
    refuse(fmt::format("numbers for a parameter that holds texts such as \"{}\"", value.text), "a list of such texts, or \"each\"");
  for (const auto& i : parameter.intervals)
    if (i.holds(*value.number)) return parameter.name + " " + text_of(i);
  return {};
}

}  // namespace

const PolicyType* entry_for(const Policy& policy, const std::string& type, bool whole_plant) {
  const PolicyType* any = nullptr;
  for (const auto& entry : policy.types) {
    if (entry.type == type) return &entry;
    if (entry.type == "*") any = &entry;
  }
  return whole_plant ? nullptr : any;
}

std::optional<std::string> policy_key(const Policy& policy, const PolicyType& entry, const Subtrees& subtrees, std::uint32_t structure,
                                      std::size_t& lacking) {
  const std::string label = entry.type == "*" ? "any type" : entry.type;
  if (entry.converged) {
    const auto value = parameter_value(subtrees, structure, entry.converged->parameter);
    if (value && !value.number)
      throw InputError(where_of(policy, entry, entry.converged->line, "converged.parameter"),
                       fmt::format("\"{}\", which holds texts such as \"{}\"", entry.converged->parameter, value.text),
                       "a parameter that holds numbers");
    if (value.number && *value.number > entry.converged->above)
      return fmt::format("{}: {} above {}", label, entry.converged->parameter, entry.converged->above);
  }
  std::string key = label;
  const char* separator = ": ";
  for (const auto& parameter : entry.parameters) {
    const auto value = parameter_value(subtrees, structure, parameter.name);
    if (!value) {
      ++lacking;
      return {};
    }
    const auto bin = bin_of(policy, entry, parameter, value);
    if (!bin) return {};
    key += separator + *bin;
    separator = ", ";
  }
  return key;
}

void check_policy(const Policy& policy, const std::vector<const Subtrees*>& plants, std::vector<std::string>& notes) {
  std::set<std::string> types, unnamed;
  for (const auto* plant : plants) types.insert(plant->plant().types.begin(), plant->plant().types.end());
  for (const auto& type : types)
    if (std::none_of(policy.types.begin(), policy.types.end(), [&](const auto& entry) { return entry.type == type; })) unnamed.insert(type);
  std::string names;
  for (const auto* plant : plants) names += (names.empty() ? "\"" : ", \"") + plant->entry().name + "\"";

  for (const auto& entry : policy.types) {
    if (entry.type != "*" && types.count(entry.type) == 0) {
      const std::vector<std::string> known(unnamed.begin(), unnamed.end());
      const std::string nearest = nearest_name(entry.type, known);
      if (!nearest.empty())
        throw InputError(where_of(policy, entry, entry.line, ""), fmt::format("a structure type that {} does not have", names),
                         fmt::format("one that it has; did you mean \"{}\"?", nearest));
      notes.push_back(fmt::format("{}: {} has no structure of this type", where_of(policy, entry, entry.line, ""), names));
      continue;
    }
    std::vector<std::pair<std::string, std::pair<long, std::string>>> wanted;
    for (const auto& p : entry.parameters) wanted.push_back({p.name, {p.line, "parameters." + p.name}});
    if (entry.converged) wanted.push_back({entry.converged->parameter, {entry.converged->line, "converged.parameter"}});
    for (const auto& [name, place] : wanted) {
      const auto& derived = derived_parameters();
      if (std::find(derived.begin(), derived.end(), name) != derived.end()) continue;
      bool there = false;
      std::set<std::string> attributes(derived.begin(), derived.end());
      for (const auto* subtrees : plants)
        for (const auto& structure : subtrees->plant().structures) {
          const Plant& plant = subtrees->plant();
          if (entry_for(policy, plant.types[structure.type], structure.parent == no_parent) != &entry) continue;
          for (const auto& [key, value] : structure.attributes) {
            attributes.insert(plant.attribute_names[key]);
            there = there || plant.attribute_names[key] == name;
          }
        }
      if (there) continue;
      const std::vector<std::string> known(attributes.begin(), attributes.end());
      const std::string nearest = nearest_name(name, known);
      throw InputError(where_of(policy, entry, place.first, place.second),
                       fmt::format("\"{}\", which no structure of type {} of {} has", name, entry.type, names),
                       "one of " + joined(known) + (nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
    }
  }
}

}  // namespace sunfleck
