// Open Plant Format with numbers added to its structures, so that AMAP tools go on from them.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Numbers that structures gain; NaN where a structure has none.
struct StructureColumns {
  std::vector<std::string> names;           ///< letters, digits, "_", "." and "-", a letter first: names of XML elements
  std::vector<std::vector<double>> values;  ///< [column][structure]
};

/// Writes a plant in metres as an OPF in centimetres, as AMAP tools have it: its structures by their types, links (the attribute "link":
/// decomp, branch or follow; decomp where there is none), "scale" and "id" (depth and row where there are none), attributes and columns.
/// An organ's shapes become one mesh where there are several. Facets keep their order but for organs whose shapes lie apart.
/// Throws OutputError.
void write_opf(const Plant& plant, const StructureColumns& columns, const std::string& file);

/// Copies an OPF as it is and adds the columns to its structures; a number that is there under the same name is replaced. Throws InputError
/// naming the original if it cannot be read or its structures are not `structures` many.
void add_to_opf(const std::string& original, const StructureColumns& columns, std::size_t structures, const std::string& file);

}  // namespace sunfleck
