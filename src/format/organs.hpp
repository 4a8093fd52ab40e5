// Organs of files that name none: pieces of the mesh that share vertex indices.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/plant/mesh.hpp>

namespace sunfleck {

/// For every triangle the number of its connected component; components are numbered in the order of their first triangle.
/// Two triangles are connected if they share a vertex index (equal coordinates do not connect them).
std::vector<std::uint32_t> connected_components(const Mesh& mesh);

}  // namespace sunfleck
