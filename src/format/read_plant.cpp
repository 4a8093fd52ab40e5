#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
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

}  // namespace

Plant read_plant(const std::string& file, double unit_m) {
  if (!std::isfinite(unit_m) || unit_m <= 0) throw InputError(file, fmt::format("unit of {} m", unit_m), "a length above zero");
  check_readable(file);
  Plant plant = read_by_suffix(file);
  if (unit_m != 1.0) plant.scale_lengths(unit_m);
  return plant;
}

}  // namespace sunfleck
