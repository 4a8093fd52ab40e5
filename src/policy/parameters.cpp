#include "policy/parameters.hpp"

#include <algorithm>
#include <cmath>

#include <sunfleck/plant/describe.hpp>
#include <sunfleck/policy/classes.hpp>

namespace sunfleck {

namespace {

ParameterValue number(double value, bool whole) {
  return {value, {}, whole};
}

ParameterValue of_attribute(const AttributeValue& value) {
  if (const auto* b = std::get_if<bool>(&value)) return {{}, *b ? "true" : "false", false};
  if (const auto* i = std::get_if<std::int64_t>(&value)) return number(static_cast<double>(*i), true);
  if (const auto* d = std::get_if<double>(&value)) return number(*d, *d == std::floor(*d));
  return {{}, std::get<std::string>(value), false};
}

double extent_along_axis(const Subtrees& subtrees, std::uint32_t structure) {
  const Vec3 axis = subtrees.frame(structure).linear[2];
  double low = INFINITY, high = -INFINITY;
  for (const auto& triangle : subtrees.facets(structure))
    for (const auto& p : triangle) {
      low = std::min(low, glm::dot(axis, p));
      high = std::max(high, glm::dot(axis, p));
    }
  return high > low ? high - low : 0.0;
}

}  // namespace

const std::vector<std::string>& derived_parameters() {
  static const std::vector<std::string> names{"type", "leaf_count", "order", "area", "length", "height"};
  return names;
}

ParameterValue parameter_value(const Subtrees& subtrees, std::uint32_t structure, const std::string& name) {
  const Plant& plant = subtrees.plant();
  if (const auto* value = plant.attribute(structure, name)) return of_attribute(*value);
  const Moments& m = subtrees.moments(structure);
  if (name == "type") return {{}, plant.types[plant.structures[structure].type], false};
  if (name == "leaf_count") return number(static_cast<double>(m.leaves), true);
  if (name == "order") return number(branching_order(plant, structure), true);
  if (name == "area") return number(m.area, false);
  if (name == "length") return number(extent_along_axis(subtrees, structure), false);
  if (name == "height") return number(m.bounds.empty() ? 0.0 : m.bounds.size().z, false);
  return {};
}

std::vector<StructureValues> structure_values(const PlantEntry& entry, const std::vector<std::string>& parameters) {
  const Subtrees subtrees(entry);
  std::vector<StructureValues> all(entry.plant->structures.size());
  for (std::uint32_t s = 0; s < all.size(); ++s) {
    all[s].facets = subtrees.moments(s).facets;
    for (const auto& name : parameters) all[s].numbers.push_back(parameter_value(subtrees, s, name).number);
  }
  return all;
}

}  // namespace sunfleck
