// Files that are written beside the one that was asked for, under a name made from its own.
#pragma once

#include <string>
#include <string_view>

namespace sunfleck {

/// First line of the material libraries that we write; those without it belong to someone else.
inline constexpr std::string_view material_library_mark = "# materials, written by sunfleck\n";

/// "wheat.mtl" beside "wheat.obj".
std::string material_library_beside(const std::string& obj);
/// "field.xdmf.h5" beside "field.xdmf".
std::string heavy_data_beside(const std::string& xdmf);

/// Whether a file is a material library of ours.
bool is_our_material_library(const std::string& file);

}  // namespace sunfleck
