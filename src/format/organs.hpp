// Organs of files that name none: connected pieces of the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/plant/mesh.hpp>

namespace sunfleck {

/// For every triangle the number of its connected component; components are numbered in the order of their first triangle.
/// Two triangles are connected if they share a vertex index, or an edge whose ends have equal coordinates, as in meshes that give every
/// triangle corners of its own.
std::vector<std::uint32_t> connected_components(const Mesh& mesh);

}  // namespace sunfleck
