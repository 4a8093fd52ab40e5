// Where the lattice of a scene stands, and how fine it is.
#pragma once

#include <optional>

#include <sunfleck/scene/facets.hpp>
#include <sunfleck/scene/scene.hpp>

#include "lattice/clip_triangle.hpp"

namespace sunfleck {

/// Cells over a box, `nodes` along its longest side.
NodeGrid grid_over(const Box& box, std::uint32_t nodes);

/// Over all plants, down to a flat ground, and as far beside them over it as they are high: what it sends up meets them from there, too. A
/// periodic cell is cut into whole cells. A ground that is a mesh is taken for leaves.
NodeGrid stand_grid(const Scene& scene, const FacetScene& facets, std::uint32_t nodes);

/// Facets below which there are no others: of flat ground.
bool has_flat_ground(const Scene& scene);

}  // namespace sunfleck
