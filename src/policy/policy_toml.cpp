#include <sunfleck/policy/policy_toml.hpp>

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "format/toml_value.hpp"

namespace sunfleck {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

TomlSchema policy_schema() {
  const TomlSchema type =
      TomlSchema::of({"representative", "scale", "align", "least_members"},
                     {{"parameters", TomlSchema::names(TomlSchema::leaf())}, {"converged", TomlSchema::of({"parameter", "above"})}});
  return TomlSchema::of({}, {{"type", TomlSchema::names(type)}, {"tables", TomlSchema::of({"basis", "order", "error", "field_pixels"})}});
}

bool all_are(const std::vector<TomlValue>& items, bool (TomlValue::*is)() const) {
  for (const auto& item : items)
    if (!(item.*is)()) return false;
  return !items.empty();
}

/// [1, 4, 16]: [1, 4), [4, 16), [16, infinity).
std::vector<Interval> from_bounds(const std::vector<TomlValue>& items) {
  std::vector<Interval> intervals;
  for (const auto& item : items) {
    const double bound = item.number();
    if (!intervals.empty()) {
      if (!(bound > intervals.back().low))
        item.fail(fmt::format("{} after {}", bound, intervals.back().low),
                  "bounds that rise: each begins the interval that ends at the next");
      intervals.back().high = bound;
    }
    intervals.push_back({bound, unbounded});
  }
  return intervals;
}

/// [[1, 4], [8, 16]]: [1, 4), [8, 16).
std::vector<Interval> from_pairs(const std::vector<TomlValue>& items) {
  std::vector<Interval> intervals;
  for (const auto& item : items) {
    const auto pair = item.numbers(2, "the low end, which belongs to the interval, and the high end, which does not");
    if (!(pair[0] < pair[1])) item.fail(fmt::format("[{}, {})", pair[0], pair[1]), "a low end below the high end");
    if (!intervals.empty() && pair[0] < intervals.back().high)
      item.fail(fmt::format("[{}, {}) after [{}, {})", pair[0], pair[1], intervals.back().low, intervals.back().high),
                "intervals that rise and do not overlap");
    intervals.push_back({pair[0], pair[1]});
  }
  return intervals;
}

PolicyParameter read_parameter(const std::string& name, const TomlValue& value) {
  static const std::string expected =
      "rising bounds like [1, 4, 16], intervals like [[1, 4], [4, 16]], values like [\"a\", \"b\"], or \"each\"";
  PolicyParameter parameter;
  parameter.name = name;
  parameter.line = value.line();
  if (value.is_text()) {
    if (value.text() != "each") value.fail(expected);
    parameter.each = true;
    return parameter;
  }
  if (!value.is_array()) value.fail(expected);
  const auto items = value.items();
  if (items.empty()) value.fail(expected);
  if (all_are(items, &TomlValue::is_text)) {
    for (const auto& item : items) {
      const std::string text = item.text();
      for (const auto& known : parameter.values)
        if (known == text) item.fail(fmt::format("\"{}\" twice", text), "each value once");
      parameter.values.push_back(text);
    }
  } else {
    parameter.intervals = all_are(items, &TomlValue::is_array) ? from_pairs(items) : from_bounds(items);
  }
  return parameter;
}

PolicyType read_type(const std::string& name, const TomlValue& table) {
  PolicyType type;
  type.type = name;
  type.line = table.line();
  if (const auto parameters = table.get("parameters"))
    for (const auto& [key, value] : parameters->members()) type.parameters.push_back(read_parameter(key, value));
  if (const auto converged = table.get("converged")) {
    Convergence c;
    c.line = converged->line();
    c.parameter = converged->need("parameter", "the name of a parameter, like \"leaf_count\"").text();
    c.above = converged->need("above", "the value above which all structures are one class").number();
    type.converged = c;
  }
  if (const auto value = table.get("representative")) {
    const std::string choice = value->one_of({"medoid", "first", "largest"});
    type.representative = choice == "medoid" ? Representative::medoid : choice == "first" ? Representative::first : Representative::largest;
  }
  if (const auto value = table.get("scale")) type.scale = value->one_of({"area", "size"}) == "area" ? StandIn::area : StandIn::size;
  if (const auto value = table.get("align"))
    type.align = value->one_of({"upright", "frame"}) == "frame" ? Alignment::frame : Alignment::upright;
  if (const auto value = table.get("least_members")) type.least_members = static_cast<std::uint32_t>(value->integer(1, 1000000000));
  return type;
}

TableSettings read_tables(const TomlValue& table) {
  TableSettings tables;
  if (const auto value = table.get("basis"))
    tables.basis = value->one_of({"sh", "directions"}) == "sh" ? TableSettings::Basis::harmonics : TableSettings::Basis::directions;
  if (const auto value = table.get("order")) {
    if (tables.basis == TableSettings::Basis::directions)
      value->fail("`order` beside basis = \"directions\"", "it with basis = \"sh\" only");
    tables.order = static_cast<std::uint32_t>(value->integer(1, 6));
  }
  if (const auto value = table.get("error")) tables.error = value->number(1e-4, 0.1);
  if (const auto value = table.get("field_pixels")) tables.field_pixels = static_cast<std::uint32_t>(value->integer(1, 64));
  return tables;
}

}  // namespace

Policy read_policy(const std::string& file) {
  const TomlDocument document(file);
  document.check_keys(policy_schema());
  const TomlValue root = document.root();
  Policy policy;
  policy.file = file;
  if (const auto types = root.get("type"))
    for (const auto& [name, table] : types->members()) policy.types.push_back(read_type(name, table));
  if (const auto tables = root.get("tables")) policy.tables = read_tables(*tables);
  return policy;
}

PolicySet read_policies(const Scene& scene) {
  PolicySet policies;
  for (const auto& entry : scene.plants)
    if (!entry.policy_file.empty() && !policies.count(entry.policy_file))
      policies.emplace(entry.policy_file, read_policy(entry.policy_file));
  return policies;
}

std::optional<Classification> classes_of_policies(const Scene& scene) {
  const auto policies = read_policies(scene);
  return policies.empty() ? std::nullopt : std::optional(classify(scene, policies));
}

}  // namespace sunfleck
