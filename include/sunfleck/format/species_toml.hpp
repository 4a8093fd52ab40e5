// Species files: TOML as docs/species.md describes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <sunfleck/plant/species.hpp>

namespace sunfleck {

/// Whether a TOML file is a species: it names the program that grows it, which a scene does not. Throws InputError if it is no TOML.
bool is_species(const std::string& file);

/// Reads a species. Throws InputError with file, line and key for a value out of its range; all unknown keys at once, each with
/// the nearest known one.
Species read_species(const std::string& file);

/// Reads a species and grows it, to the file's own age and seed unless others are given. Throws InputError as read_species and grow do.
Plant read_species_plant(const std::string& file, std::optional<double> age = {}, std::optional<std::uint64_t> seed = {});

}  // namespace sunfleck
