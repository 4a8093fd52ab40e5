// A plant: a tree of botanical structures, some of which carry shapes (pieces of meshes placed by affine maps).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <sunfleck/plant/mesh.hpp>

namespace sunfleck {

using AttributeValue = std::variant<bool, std::int64_t, double, std::string>;

inline constexpr std::uint32_t no_parent = 0xffffffffu;

/// One botanical structure (plant, axis, metamer, leaf, ...). A structure that owns shapes is an *organ*.
struct Structure {
  std::uint32_t parent = no_parent;  ///< index into Plant::structures; parents come before their children
  std::uint32_t type = 0;            ///< index into Plant::types
  std::string name;                  ///< unique among siblings where the file gives names; may be empty
  Affine frame;                      ///< local frame -> plant frame; a structure's axis runs along its local +z (OPF: +x)
  std::vector<std::pair<std::uint32_t, AttributeValue>> attributes;  ///< (index into Plant::attribute_names, value)
};

/// A run of triangles of one mesh, placed in the plant. Shapes are listed in the order of the file: that is the facet order.
struct Shape {
  std::uint32_t structure = 0;  ///< the organ it belongs to
  std::uint32_t mesh = 0;       ///< index into Plant::meshes
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t material = 0;  ///< index into Plant::materials: OBJ material, or "" where the file names none
  Affine placement;            ///< mesh coordinates -> plant frame [m]; where it mirrors, fronts stay fronts (corners swapped)
};

/// Structures in depth-first order; [0] is the plant itself.
struct Plant {
  std::string name;
  std::string file;  ///< where it was read from, for messages; empty if made in memory
  std::vector<std::string> types;
  std::vector<std::string> attribute_names;
  std::vector<std::string> materials;
  std::vector<Structure> structures;
  std::vector<Mesh> meshes;
  std::vector<Shape> shapes;
  std::vector<std::string> notes;  ///< what its reader wants the user to know; no part of the plant

  std::size_t facet_count() const;
  /// One-sided area of all facets in the plant's own unit, squared [m^2].
  double area() const;
  Box bounds() const;
  /// Index of a type, attribute or material name, appended if new.
  std::uint32_t type_index(const std::string& type_name);
  std::uint32_t attribute_index(const std::string& attribute_name);
  std::uint32_t material_index(const std::string& material_name);
  /// The value of an attribute of a structure, or null.
  const AttributeValue* attribute(std::uint32_t structure, const std::string& attribute_name) const;
  /// Scales all lengths (vertices stay, frames and placements change): s = 0.01 turns centimetres into metres.
  void scale_lengths(double s);
};

/// Throws InputError naming the plant's file if an index is out of range, a parent does not precede its child, a coordinate
/// or map is not finite, or there is no facet at all.
void check_plant(const Plant& plant);

/// Corners of triangle t (relative to shape.first_triangle) of a shape in the plant frame, front orientation kept under mirrors.
Triangle shape_triangle(const Plant& plant, const Shape& shape, std::uint32_t t);

}  // namespace sunfleck
