// Triangle meshes as the files have them: every face, in order, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Corners are vertex indices, counter-clockwise seen from the front. Polygons of a file are fans from their first vertex.
struct Mesh {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;

  Triangle corners(std::size_t t) const {
    const auto& i = triangles[t];
    return {vertices[i[0]], vertices[i[1]], vertices[i[2]]};
  }
};

/// Throws InputError naming `where` on a vertex that is not finite or an index out of range.
void check_mesh(const Mesh& mesh, const std::string& where);

}  // namespace sunfleck
