#include <sunfleck/core/companion_file.hpp>

#include <filesystem>
#include <fstream>

namespace sunfleck {

std::string material_library_beside(const std::string& obj) {
  return std::filesystem::path(obj).replace_extension(".mtl").string();
}

std::string heavy_data_beside(const std::string& xdmf) {
  return xdmf + ".h5";
}

bool is_our_material_library(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::string first(material_library_mark.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(first.data(), static_cast<std::streamsize>(first.size()));
  return in && first == material_library_mark;
}

}  // namespace sunfleck
