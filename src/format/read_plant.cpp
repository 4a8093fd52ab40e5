#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/format/species_toml.hpp>

namespace sunfleck {

namespace {

Plant read_by_suffix(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".opf") return read_opf(file);
  if (suffix == ".obj") return read_obj(file);
  if (suffix == ".ply") return read_ply(file);
  if (suffix == ".can") return read_can(file);
  if (suffix == ".h5") return read_plant_h5(file);
  if (suffix == ".toml") return read_species_plant(file);
  throw InputError(file, suffix.empty() ? "no suffix" : "suffix " + in_quotes(suffix), ".opf, .obj, .ply, .can, .h5 or .toml (a species)");
}

/// Names as every output can hold them: UTF-8 on one line.
void clean_names(Plant& plant) {
  std::size_t changed = 0;
  const auto clean = [&](std::string& name) {
    if (!is_utf8(name) || has_control_character(name)) ++changed, name = clean_name(name);
  };
  clean(plant.name);
  for (auto* names : {&plant.types, &plant.attribute_names, &plant.materials})
    for (auto& name : *names) clean(name);
  for (auto& structure : plant.structures) {
    clean(structure.name);
    for (auto& [key, value] : structure.attributes)
      if (auto* text = std::get_if<std::string>(&value)) clean(*text);
  }
  if (changed > 0)
    plant.notes.push_back(
        fmt::format("{}: {} with control characters, or bytes that are no UTF-8: blanks and letters of Windows-1252 take "
                    "their place",
                    plant.file, changed == 1 ? "a name" : fmt::format("{} names", changed)));
}

}  // namespace

Plant read_plant(const std::string& file, double unit_m) {
  if (!std::isfinite(unit_m) || unit_m <= 0) throw InputError(file, fmt::format("unit of {} m", unit_m), "a length above zero");
  check_readable(file);
  Plant plant = read_by_suffix(file);
  clean_names(plant);
  if (unit_m != 1.0) plant.scale_lengths(unit_m);
  return plant;
}

}  // namespace sunfleck
