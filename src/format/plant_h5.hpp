// The layout of our own plant files, shared by writer and reader. docs/formats-plants.md shows it to users.
//   attrs            format "sunfleck-plant", format_version, name
//   /names/type /attribute /material /structure /text     string tables; the rest of the file names rows of them
//   /structures/parent /type /name [n] uint32, frame [n, 3, 4] float64
//   /attributes/structure /key [k] uint32, kind [k] uint8, whole [k] int64 (also truth values and rows of /names/text), number [k] float64
//   /meshes/vertex_count /triangle_count [m] uint64, vertices [v, 3] float64 [m], triangles [t, 3] uint32 (from 0 in each mesh)
//   /shapes/structure /mesh /first_triangle /triangle_count /material [s] uint32, placement [s, 3, 4] float64
#pragma once

#include <array>
#include <cstdint>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck::plant_h5 {

inline constexpr const char* format_name = "sunfleck-plant";
inline constexpr std::int64_t format_version = 1;

/// Kinds of attribute values: the alternatives of AttributeValue, in order.
enum ValueKind : std::uint8_t { truth = 0, whole = 1, number = 2, text = 3 };

/// Three rows of four: linear part and translation.
using FrameRows = std::array<double, 12>;

inline FrameRows matrix_of(const Affine& a) {
  FrameRows m{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[4 * row + column] = a.linear[column][row];
    m[4 * row + 3] = a.translation[row];
  }
  return m;
}

inline Affine affine_of(const FrameRows& m) {
  Affine a;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) a.linear[column][row] = m[4 * row + column];
    a.translation[row] = m[4 * row + 3];
  }
  return a;
}

}  // namespace sunfleck::plant_h5
