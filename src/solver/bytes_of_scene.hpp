// Bytes that a solve holds besides those of its method, from counts alone: what takes no time to know.
#pragma once

#include <cstdint>

#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck {

std::uint64_t copies_of(const SceneCounts& counts);
/// Copies with their names (PlacedScene), names of the ground's cells (the tables of the writer).
std::uint64_t layout_bytes(const SceneCounts& counts);
/// Every copy and the ground written out (FacetScene).
std::uint64_t expanded_bytes(const SceneCounts& counts);
/// Rays' tree over facets that are written out, about: Embree's tree and its copy of a triangle.
std::uint64_t tree_bytes(const SceneCounts& counts);
/// Sums over the organs of the largest copy, or of the ground, and chunks that wait for the disk (ResultWriter).
std::uint64_t row_bytes(const Scene& scene, const SceneCounts& counts);

/// Bytes of one facet: irradiance and sunlit fraction of both sides under every state.
std::uint64_t solution_bytes_per_facet(const Scene& scene);
/// Bytes of one row of a result before compression: irradiance, absorbed, sunlit, area, centroid, organ.
std::uint64_t result_bytes_per_facet(const Scene& scene);

}  // namespace sunfleck
