// From a scene to the geometry and tables of its originals.
#pragma once

#include <sunfleck/original/cache.hpp>
#include <sunfleck/policy/classes.hpp>

namespace sunfleck {

/// Geometry of the representative of a class in the frame in which it lies (the plant's; a plant's or group's own), under
/// OriginalClass::stretch. Tables measured from it serve member m as transformed(tables, m.from_representative.linear). Materials are those
/// of the scene. Throws InputError if a group has more facets than `most_facets`.
OriginalGeometry original_geometry(const Scene& scene, const OriginalClass& original, std::uint64_t most_facets = 1u << 24);

/// Geometry of one structure of a plant in the plant's frame.
OriginalGeometry structure_geometry(const Scene& scene, std::uint32_t plant, std::uint32_t structure);

}  // namespace sunfleck
