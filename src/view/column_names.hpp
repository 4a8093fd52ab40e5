// Names of bands and states in the columns of exports.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

/// Letters, digits and _.-: of ASCII; any other sign, of one byte or several, becomes _. What PLY, OBJ and VTK take for a name.
std::string plain_name(const std::string& text);
/// The same without the colon: XML takes it for its own.
std::string attribute_name(const std::string& text);
/// The text itself: tables take any name.
std::string same_name(const std::string& text);

/// What columns call bands and states: cleaned, and no two alike.
struct ColumnNames {
  using Clean = std::string (*)(const std::string&);
  ColumnNames(const Result& result, Clean clean);
  std::vector<std::string> bands, states;
};

}  // namespace sunfleck
