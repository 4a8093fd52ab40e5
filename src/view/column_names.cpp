#include "view/column_names.hpp"

#include <cctype>

#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

std::string with_only(const std::string& text, const std::string& signs) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x80 && std::isalnum(byte)) || signs.find(c) != std::string::npos)
      name += c;
    else if ((byte & 0xC0) != 0x80)  // one for a letter of several bytes
      name += '_';
  }
  return name;
}

std::vector<std::string> state_names(const Result& result) {
  std::vector<std::string> names;
  for (const auto& state : result.states()) names.push_back(state.name);
  return names;
}

}  // namespace

std::string plain_name(const std::string& text) {
  return with_only(text, "_.-:");
}

std::string attribute_name(const std::string& text) {
  return with_only(text, "_.-");
}

std::string same_name(const std::string& text) {
  return text;
}

ColumnNames::ColumnNames(const Result& result, Clean clean)
    : bands(distinct_names(result.bands(), clean)), states(distinct_names(state_names(result), clean)) {}

}  // namespace sunfleck
