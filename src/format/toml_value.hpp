// TOML with manners: every value knows its file, line and key, so that every error does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

struct TomlParsed;  // toml++'s document: known to toml_value.cpp only, for the sake of compile times

/// Which keys a table may have. Keys without a schema of their own may hold anything.
struct TomlSchema {
  std::vector<std::pair<std::string, TomlSchema>> keys;
  bool any_key = false;            ///< keys are names that the user chooses ...
  std::vector<TomlSchema> of_any;  ///< ... and this (none or one) is the schema of what they hold
  bool open = false;               ///< nothing below is looked at

  static TomlSchema leaf() { return {{}, false, {}, true}; }
  static TomlSchema names(TomlSchema below) { return {{}, true, {std::move(below)}, false}; }
  /// A table whose keys hold plain values.
  static TomlSchema of(const std::vector<std::string>& plain, std::vector<std::pair<std::string, TomlSchema>> deeper = {});
};

/// One value of a document. Cheap to copy; lives as long as its document.
class TomlValue {
 public:
  const std::string& path() const { return path_; }  ///< "plant[0].place[2].turn"
  long line() const;
  std::string where() const;  ///< "FILE:LINE: PATH"
  /// "FILE:LINE: PATH.key", at the line of this table: for a key that is not there.
  std::string where(const std::string& key) const;
  [[noreturn]] void fail(const std::string& expected) const;  ///< found: this value as text
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

  bool is_table() const;
  bool is_array() const;
  bool is_text() const;
  bool is_date_time() const;

  /// Member of a table; nothing if it is not there. Fails if this is not a table.
  std::optional<TomlValue> get(const std::string& key) const;
  TomlValue need(const std::string& key, const std::string& expected) const;
  bool has(const std::string& key) const { return get(key).has_value(); }
  std::vector<std::pair<std::string, TomlValue>> members() const;  ///< of a table, by rising key
  std::vector<TomlValue> items() const;                            ///< of an array
  std::vector<TomlValue> tables() const;                           ///< of an array of tables; a single table counts as one

  double number() const;                                                       ///< finite, integer or float
  double number(double low, double high, const std::string& unit = {}) const;  ///< in [low, high]
  double up_to(double most, const std::string& unit = {}) const;               ///< from zero to a limit that few know of
  double positive(const std::string& unit = {}) const;                         ///< > 0
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  bool flag() const;
  std::string text() const;  ///< not empty
  std::string one_of(const std::vector<std::string>& names) const;
  std::string date_time() const;                                                   ///< a string, or a TOML date-time as ISO 8601
  std::vector<double> numbers(std::size_t count, const std::string& names) const;  ///< exactly `count`; names: "x, y, z [m]"

 private:
  friend class TomlDocument;
  TomlValue(const TomlParsed* document, const void* node, long line, std::string path)
      : document_(document), node_(node), line_(line), path_(std::move(path)) {}
  std::string found() const;

  const TomlParsed* document_;
  const void* node_;
  long line_;
  std::string path_;
};

class TomlDocument {
 public:
  /// Throws InputError if the file is missing, a folder, not readable or not TOML.
  explicit TomlDocument(const std::string& file);
  /// The same for a text that was read from a file of that name.
  TomlDocument(std::string text, const std::string& file);
  ~TomlDocument();
  TomlDocument(const TomlDocument&) = delete;
  TomlDocument& operator=(const TomlDocument&) = delete;

  const std::string& file() const;
  const std::string& text() const;
  TomlValue root() const;
  /// Throws one InputError that lists every key the schema does not know, a line each:
  /// "scene.toml:12: sky.modell: unknown key; did you mean "model"?"
  void check_keys(const TomlSchema& schema) const;

 private:
  std::unique_ptr<TomlParsed> parsed_;
};

}  // namespace sunfleck
