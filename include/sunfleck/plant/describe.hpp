// What a plant holds, in numbers and in words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// Structures of one type. An organ is a structure that owns shapes; its facets and area are its own, without those of its children.
struct TypeSummary {
  std::string type;
  std::size_t structures = 0;
  std::size_t organs = 0;
  std::size_t facets = 0;
  double area_m2 = 0;  ///< one-sided [m^2]
};

/// Counts, areas and bounds of a plant whose lengths are metres.
struct PlantSummary {
  std::string name, file;
  std::vector<TypeSummary> types;  ///< in the order of Plant::types
  std::size_t structures = 0, organs = 0, facets = 0;
  std::size_t zero_area_facets = 0;  ///< kept as rows of zeros, never traced
  std::size_t meshes = 0;            ///< shared between shapes
  std::size_t shapes = 0;
  std::vector<std::string> materials;   ///< names; "" where the file names none
  std::vector<std::string> attributes;  ///< names
  std::vector<std::string> notes;       ///< of the reader
  double area_m2 = 0;                   ///< one-sided [m^2]
  Box bounds;                           ///< [m]; a vertex that no facet uses does not count
};

PlantSummary summarize_plant(const Plant& plant);

/// Bytes that a plant holds.
std::size_t held_bytes(const Plant& plant);

/// The summary as a few lines of text, with a final line end.
std::string describe_plant(const Plant& plant);
std::string describe_plant(const PlantSummary& summary);

/// Order of branching: axis-like structures (types axis, branch, trunk, stem, tiller, in any case) from the plant down to a structure,
/// itself included.
std::uint32_t branching_order(const Plant& plant, std::uint32_t structure);

}  // namespace sunfleck
