#include <sunfleck/policy/policy.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace sunfleck {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

/// A bare key where TOML allows it.
std::string key(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(),
                                                 [](unsigned char c) { return (c < 0x80 && std::isalnum(c)) || c == '_' || c == '-'; });
  return bare ? name : quoted(name);
}

std::string text_of(const PolicyParameter& parameter) {
  if (parameter.each) return "\"each\"";
  std::vector<std::string> items;
  for (const auto& value : parameter.values) items.push_back(quoted(value));
  const auto& intervals = parameter.intervals;
  bool bounds = !intervals.empty() && std::isinf(intervals.back().high);
  for (std::size_t i = 1; i < intervals.size(); ++i) bounds = bounds && intervals[i - 1].high == intervals[i].low;
  for (const auto& i : intervals) items.push_back(bounds ? fmt::format("{}", i.low) : fmt::format("[{}, {}]", i.low, i.high));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

}  // namespace

std::string name_of(Representative representative) {
  return representative == Representative::medoid ? "medoid" : representative == Representative::first ? "first" : "largest";
}
std::string name_of(StandIn scale) {
  return scale == StandIn::area ? "area" : "size";
}
std::string name_of(Alignment align) {
  return align == Alignment::upright ? "upright" : "frame";
}
std::string name_of(TableSettings::Basis basis) {
  return basis == TableSettings::Basis::harmonics ? "sh" : "directions";
}

std::string policy_text(const Policy& policy) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const auto& type : policy.types) {
    fmt::format_to(out, "[type.{}]\n", key(type.type));
    std::vector<std::string> parameters;
    for (const auto& p : type.parameters) parameters.push_back(key(p.name) + " = " + text_of(p));
    if (!parameters.empty()) fmt::format_to(out, "parameters = {{ {} }}\n", fmt::join(parameters, ", "));
    if (type.converged)
      fmt::format_to(out, "converged = {{ parameter = {}, above = {} }}\n", quoted(type.converged->parameter), type.converged->above);
    fmt::format_to(out, "representative = \"{}\"\nscale = \"{}\"\nalign = \"{}\"\nleast_members = {}\n\n", name_of(type.representative),
                   name_of(type.scale), name_of(type.align), type.least_members);
  }
  fmt::format_to(out, "[tables]\nbasis = \"{}\"\n", name_of(policy.tables.basis));
  if (policy.tables.basis == TableSettings::Basis::harmonics) fmt::format_to(out, "order = {}\n", policy.tables.order);
  fmt::format_to(out, "error = {}\nfield_pixels = {}\n", policy.tables.error, policy.tables.field_pixels);
  return text;
}

}  // namespace sunfleck
