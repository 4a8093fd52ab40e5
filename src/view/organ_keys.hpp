// What organs have in common: the keys of grouped tables.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "view/organ_rows.hpp"

namespace sunfleck {

enum class GroupKeyKind { plant, placement, type, name, order, attribute, layer };

struct GroupKey {
  std::string name;
  GroupKeyKind kind = GroupKeyKind::attribute;
  double depth = 0;  ///< of layers [m]; 0 = a twentieth of the plants' height
};

/// "plant", "placement", "type", "name", "order", "layer", "layer:0.5", else an attribute. Throws UsageError for a depth that is none.
GroupKey key_of(const std::string& word);

/// The values of a key that the scene has, as row numbers. Numbers sort by value, texts by their first appearance; nothing comes last.
class KeyTable {
 public:
  std::uint32_t row(double number);
  std::uint32_t row(const std::string& text);
  std::uint32_t row(const AttributeValue& value);
  std::uint32_t row_of_nothing();
  /// For a field of a CSV file.
  std::string text(std::uint32_t row) const;
  /// Place of every row when sorted.
  std::vector<std::uint32_t> order() const;

 private:
  struct Value {
    enum Kind : std::uint8_t { number_kind, text_kind, none } kind = none;
    double number = 0;
    std::string text;
  };
  std::uint32_t add(Value value, const std::string& code);
  std::vector<Value> values_;
  std::map<std::string, std::uint32_t> known_;
};

/// Per key a table of its values, and its row for every organ. Attributes are an organ's own, or those of the nearest structure above it
/// that has one. Throws UsageError for a name that no structure has.
class OrganKeys {
 public:
  OrganKeys(const Result& result, const std::vector<GroupKey>& keys);

  const OrganTexts& names() const { return names_; }
  const KeyTable& table(std::size_t key) const { return tables_[key]; }
  /// Row of the key's table for every organ of a range.
  std::vector<std::uint32_t> rows(std::size_t key, const OrganBlock& organs);

 private:
  std::uint32_t row(std::size_t key, const OrganBlock& organs, std::size_t i);
  void find_structures(const Result& result);

  std::string file_;
  std::vector<GroupKey> keys_;
  OrganTexts names_;
  std::vector<KeyTable> tables_;
  std::map<std::size_t, std::vector<std::uint32_t>> named_;                      ///< per key: row of its table per name
  std::map<std::size_t, std::vector<std::vector<std::uint32_t>>> of_structure_;  ///< [key][plant][structure]
  std::vector<std::uint32_t> entry_of_plant_;                                    ///< per name of a plant its row in /geometry
};

}  // namespace sunfleck
