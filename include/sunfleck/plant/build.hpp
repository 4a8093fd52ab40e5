// Plants made in memory from meshes: for tests, examples and the readers of formats without a hierarchy.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/plant/plant.hpp>

namespace sunfleck {

/// A plant without organs yet; type is that of the whole.
Plant empty_plant(const std::string& name, const std::string& file = {}, const std::string& type = "plant");

/// Appends a structure and returns its index.
std::uint32_t add_structure(Plant& plant, std::uint32_t parent, const std::string& type, const std::string& name);

/// Sets an attribute of a structure, replacing an earlier value.
void set_attribute(Plant& plant, std::uint32_t structure, const std::string& attribute_name, AttributeValue value);

/// A plant with one organ of the given type per mesh, in order. An organ is named NAME_1, NAME_2, ...; a single one NAME.
/// Lengths [m], fronts counter-clockwise. Throws InputError if a mesh is broken or there is no facet at all.
Plant make_plant(std::vector<Mesh> meshes, const std::string& name = "plant", const std::string& type = "organ");
Plant make_plant(Mesh mesh, const std::string& name = "plant", const std::string& type = "organ");

/// Appends the shapes of one mesh whose triangle t belongs to organ (a structure) owner[t] and has material material[t] (an
/// index into plant.materials): one shape per run of triangles with the same owner and material, in the order of the triangles.
void add_mesh(Plant& plant, Mesh mesh, const std::vector<std::uint32_t>& owner, const std::vector<std::uint32_t>& material);

}  // namespace sunfleck
