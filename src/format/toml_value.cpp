#include <format/toml_value.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <format/text.hpp>
#include <format/toml_depth.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

struct TomlParsed {
  std::string file, text;
  toml::table root;
};

namespace {

const toml::node& node_of(const void* p) {
  return *static_cast<const toml::node*>(p);
}

long line_of(const toml::node& node, long otherwise) {
  const auto line = static_cast<long>(node.source().begin.line);
  return line > 0 ? line : otherwise;
}

/// Lines of a text that no file holds tell nobody anything.
long line_in(const std::string& file, long line) {
  return file.empty() ? 0 : line;
}

std::string joined_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// A value for a message: short, on one line.
std::string shown(const toml::node& node) {
  std::ostringstream out;
  if (const auto* s = node.as_string()) return '"' + s->get() + '"';
  if (const auto* d = node.as_floating_point()) return fmt::format("{}", d->get());
  if (node.is_table()) return "a table";
  if (const auto* a = node.as_array()) return a->empty() ? "an empty array" : fmt::format("an array of {}", a->size());
  node.visit([&](const auto& v) {
    if constexpr (toml::is_value<decltype(v)>) out << std::boolalpha << v.get();
  });
  return out.str();
}

}  // namespace

TomlSchema TomlSchema::of(const std::vector<std::string>& plain, std::vector<std::pair<std::string, TomlSchema>> deeper) {
  TomlSchema schema;
  for (const auto& key : plain) schema.keys.emplace_back(key, leaf());
  for (auto& key : deeper) schema.keys.push_back(std::move(key));
  return schema;
}

long TomlValue::line() const {
  return line_;
}
std::string TomlValue::where() const {
  return location(document_->file, line_in(document_->file, line_), path_);
}
std::string TomlValue::where(const std::string& key) const {
  return location(document_->file, line_in(document_->file, line_), joined_path(path_, key));
}
std::string TomlValue::found() const {
  return shown(node_of(node_));
}
void TomlValue::fail(const std::string& expected) const {
  throw InputError(where(), found(), expected);
}
void TomlValue::fail(const std::string& found, const std::string& expected) const {
  throw InputError(where(), found, expected);
}

bool TomlValue::is_table() const {
  return node_of(node_).is_table();
}
bool TomlValue::is_array() const {
  return node_of(node_).is_array();
}
bool TomlValue::is_text() const {
  return node_of(node_).is_string();
}
bool TomlValue::is_date_time() const {
  return node_of(node_).is_date_time() || node_of(node_).is_date() || node_of(node_).is_time();
}

std::optional<TomlValue> TomlValue::get(const std::string& key) const {
  const auto* table = node_of(node_).as_table();
  if (!table) fail("a table");
  const auto at = table->find(key);
  if (at == table->end()) return std::nullopt;
  return TomlValue(document_, &at->second, line_of(at->second, line_), joined_path(path_, key));
}

TomlValue TomlValue::need(const std::string& key, const std::string& expected) const {
  auto value = get(key);
  if (!value) throw InputError(where(key), "nothing", expected);
  return *value;
}

std::vector<std::pair<std::string, TomlValue>> TomlValue::members() const {
  const auto* table = node_of(node_).as_table();
  if (!table) fail("a table");
  std::vector<std::pair<std::string, TomlValue>> all;
  for (const auto& [key, node] : *table) {
    const std::string name(key.str());
    all.emplace_back(name, TomlValue(document_, &node, line_of(node, line_), joined_path(path_, name)));
  }
  return all;
}

std::vector<TomlValue> TomlValue::items() const {
  const auto* array = node_of(node_).as_array();
  if (!array) fail("an array");
  std::vector<TomlValue> all;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const auto& node = *array->get(i);
    all.push_back(TomlValue(document_, &node, line_of(node, line_), fmt::format("{}[{}]", path_, i)));
  }
  return all;
}

std::vector<TomlValue> TomlValue::tables() const {
  if (is_table()) return {*this};
  if (!is_array()) fail("a table or an array of tables");
  auto all = items();
  for (const auto& item : all)
    if (!item.is_table()) item.fail("a table");
  return all;
}

double TomlValue::number() const {
  const auto& node = node_of(node_);
  double value = 0;
  if (const auto* d = node.as_floating_point())
    value = d->get();
  else if (const auto* i = node.as_integer())
    value = static_cast<double>(i->get());
  else
    fail("a number");
  if (!std::isfinite(value)) fail("a finite number");
  return value;
}

double TomlValue::number(double low, double high, const std::string& unit) const {
  const double value = number();
  const std::string suffix = unit.empty() ? "" : " " + unit;
  if (value >= low && value <= high) return value;
  if (std::isinf(high)) fail(low == 0 ? "a number of zero or more" + suffix : fmt::format("a number of at least {}{}", low, suffix));
  fail(fmt::format("a number from {} to {}{}", low, high, suffix));
}

double TomlValue::up_to(double most, const std::string& unit) const {
  const double value = number(0, std::numeric_limits<double>::infinity(), unit);
  if (value > most) fail(fmt::format("at most {:g}{}", most, unit.empty() ? "" : " " + unit));
  return value;
}

double TomlValue::positive(const std::string& unit) const {
  const double value = number();
  if (!(value > 0)) fail("a number above zero" + (unit.empty() ? "" : " " + unit));
  return value;
}

std::int64_t TomlValue::integer(std::int64_t low, std::int64_t high) const {
  const auto* i = node_of(node_).as_integer();
  const std::string expected = high == std::numeric_limits<std::int64_t>::max() ? fmt::format("a whole number of at least {}", low)
                                                                                : fmt::format("a whole number from {} to {}", low, high);
  if (!i || i->get() < low || i->get() > high) fail(expected);
  return i->get();
}

bool TomlValue::flag() const {
  const auto* b = node_of(node_).as_boolean();
  if (!b) fail("true or false");
  return b->get();
}

std::string TomlValue::text() const {
  const auto* s = node_of(node_).as_string();
  if (!s) fail("a string");
  if (s->get().empty()) fail("a string that is not empty");
  return s->get();
}

std::string TomlValue::one_of(const std::vector<std::string>& names) const {
  std::string value = text();
  for (const auto& name : names)
    if (name == value) return value;
  const std::string nearest = nearest_name(value, names);
  fail("one of " + joined(names) + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

std::string TomlValue::date_time() const {
  if (is_text()) return text();
  const auto* t = node_of(node_).as_date_time();
  if (!t) fail("a date and time with its zone, like \"2026-06-21T09:00:00+02:00\"");
  std::ostringstream out;
  out << t->get();
  return out.str();
}

std::vector<double> TomlValue::numbers(std::size_t count, const std::string& names) const {
  if (!is_array()) fail(fmt::format("an array of {} numbers: {}", count, names));
  const auto all = items();
  if (all.size() != count) fail(fmt::format("an array of {} numbers: {}", count, names));
  std::vector<double> values;
  for (const auto& item : all) values.push_back(item.number());
  return values;
}

TomlDocument::TomlDocument(const std::string& file) : TomlDocument(read_whole(file), file) {}

TomlDocument::TomlDocument(std::string text, const std::string& file) : parsed_(std::make_unique<TomlParsed>()) {
  parsed_->file = file;
  parsed_->text = without_mark(std::move(text), file);
  check_toml_keys(parsed_->text, file);
  try {
    parsed_->root = toml::parse(std::string_view(parsed_->text), std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}: not valid TOML: {}", location(file, static_cast<long>(error.source().begin.line)), error.description()));
  }
}

TomlDocument::~TomlDocument() = default;
const std::string& TomlDocument::file() const {
  return parsed_->file;
}
const std::string& TomlDocument::text() const {
  return parsed_->text;
}
TomlValue TomlDocument::root() const {
  return TomlValue(parsed_.get(), &parsed_->root, 1, "");
}

namespace {

struct Unknown {
  long line;
  std::string text;
};

void collect_unknown(const toml::node& node, const TomlSchema& schema, const std::string& path, const std::string& file,
                     std::vector<Unknown>& unknown) {
  if (schema.open) return;
  if (const auto* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i) collect_unknown(*array->get(i), schema, fmt::format("{}[{}]", path, i), file, unknown);
    return;
  }
  const auto* table = node.as_table();
  if (!table) return;  // a wrong type is reported by whoever reads the value
  std::vector<std::string> known;
  for (const auto& key : schema.keys) known.push_back(key.first);
  for (const auto& [key, value] : *table) {
    const std::string name(key.str()), full = joined_path(path, name);
    const TomlSchema* below = nullptr;
    for (const auto& k : schema.keys)
      if (k.first == name) below = &k.second;
    if (!below && schema.any_key && !schema.of_any.empty()) below = &schema.of_any.front();
    if (below) {
      collect_unknown(value, *below, full, file, unknown);
    } else if (!schema.any_key) {
      const auto line = static_cast<long>(key.source().begin.line);
      const std::string nearest = nearest_name(name, known);
      unknown.push_back({line, location(file, line_in(file, line), full) + ": unknown key; " +
                                   (nearest.empty() ? "known here: " + joined(known) : "did you mean \"" + nearest + "\"?")});
    }
  }
}

}  // namespace

void TomlDocument::check_keys(const TomlSchema& schema) const {
  std::vector<Unknown> unknown;
  collect_unknown(parsed_->root, schema, "", parsed_->file, unknown);
  if (unknown.empty()) return;
  std::stable_sort(unknown.begin(), unknown.end(), [](const Unknown& a, const Unknown& b) { return a.line < b.line; });
  std::string text;
  for (const auto& u : unknown) text += (text.empty() ? "" : "\n") + u.text;
  throw InputError(text);
}

}  // namespace sunfleck
