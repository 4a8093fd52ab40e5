// HDF5 files that lie. Metadata of HDF5 carry checksums, which random bytes do not get past; so bytes are read as a recipe of changes
// to a good file, unless they are an HDF5 file themselves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sunfleck::fuzz {

/// The bytes of a plant or result file: as given if they start with HDF5's signature, else a good file after the changes that they ask for.
/// A change: dataset, action, type, rank, dimensions, values. At most eight are made.
std::vector<std::uint8_t> changed_plant_file(std::span<const std::uint8_t> bytes);
std::vector<std::uint8_t> changed_result_file(std::span<const std::uint8_t> bytes);

}  // namespace sunfleck::fuzz
