#include <sunfleck/plant/plant.hpp>

#include <cmath>
#include <string>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const Affine& a) {
  return finite(a.linear[0]) && finite(a.linear[1]) && finite(a.linear[2]) && finite(a.translation);
}

std::uint32_t index_in(std::vector<std::string>& names, const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<std::uint32_t>(i);
  names.push_back(name);
  return static_cast<std::uint32_t>(names.size() - 1);
}

std::string coordinates(const Vec3& v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
}

}  // namespace

void check_mesh(const Mesh& mesh, const std::string& where) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!finite(mesh.vertices[i]))
      throw InputError(where, "vertex " + std::to_string(i + 1) + " = " + coordinates(mesh.vertices[i]), "finite coordinates");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto index : mesh.triangles[t])
      if (index >= mesh.vertices.size())
        throw InputError(where, "vertex index " + std::to_string(index) + " in face " + std::to_string(t + 1),
                         "an index below the number of vertices, " + std::to_string(mesh.vertices.size()));
}

std::size_t Plant::facet_count() const {
  std::size_t n = 0;
  for (const auto& s : shapes) n += s.triangle_count;
  return n;
}

double Plant::area() const {
  double total = 0;
  for (const auto& s : shapes)
    for (std::uint32_t t = 0; t < s.triangle_count; ++t) total += glm::length(area_vector(shape_triangle(*this, s, t)));
  return total;
}

Box Plant::bounds() const {
  Box box;
  for (const auto& s : shapes)
    for (std::uint32_t t = 0; t < s.triangle_count; ++t)
      for (const auto& p : shape_triangle(*this, s, t)) box.add(p);
  return box;
}

std::uint32_t Plant::type_index(const std::string& type_name) {
  return index_in(types, type_name);
}
std::uint32_t Plant::attribute_index(const std::string& attribute_name) {
  return index_in(attribute_names, attribute_name);
}
std::uint32_t Plant::material_index(const std::string& material_name) {
  return index_in(materials, material_name);
}

const AttributeValue* Plant::attribute(std::uint32_t structure, const std::string& attribute_name) const {
  for (const auto& [key, value] : structures[structure].attributes)
    if (attribute_names[key] == attribute_name) return &value;
  return nullptr;
}

void Plant::scale_lengths(double s) {
  for (auto& structure : structures) structure.frame.translation *= s;
  for (auto& shape : shapes) {
    shape.placement.linear *= s;
    shape.placement.translation *= s;
  }
}

void check_plant(const Plant& plant) {
  const std::string where = plant.file.empty() ? "plant \"" + plant.name + "\"" : plant.file;
  if (plant.structures.empty()) throw InputError(where, "no structure", "at least the plant itself");
  if (plant.structures[0].parent != no_parent) throw InputError(where, "a first structure with a parent", "the plant itself first");
  for (std::size_t i = 0; i < plant.structures.size(); ++i) {
    const auto& s = plant.structures[i];
    const std::string name = "structure " + std::to_string(i) + (s.name.empty() ? "" : " (" + s.name + ")");
    if (i > 0 && s.parent >= i) throw InputError(where, name + " with parent " + std::to_string(s.parent), "a parent that comes before it");
    if (s.type >= plant.types.size()) throw InputError(where, name + " with type number " + std::to_string(s.type), "a listed type");
    if (!finite(s.frame)) throw InputError(where, name + " with a frame that is not finite", "finite numbers");
    for (const auto& a : s.attributes)
      if (a.first >= plant.attribute_names.size())
        throw InputError(where, name + " with attribute number " + std::to_string(a.first), "a listed attribute");
  }
  for (const auto& mesh : plant.meshes) check_mesh(mesh, where);
  for (std::size_t i = 0; i < plant.shapes.size(); ++i) {
    const auto& s = plant.shapes[i];
    const std::string name = "shape " + std::to_string(i);
    if (s.structure >= plant.structures.size())
      throw InputError(where, name + " of structure " + std::to_string(s.structure), "a listed structure");
    if (s.mesh >= plant.meshes.size()) throw InputError(where, name + " with mesh " + std::to_string(s.mesh), "a listed mesh");
    if (s.material >= plant.materials.size())
      throw InputError(where, name + " with material number " + std::to_string(s.material), "a listed material");
    if (std::uint64_t{s.first_triangle} + s.triangle_count > plant.meshes[s.mesh].triangles.size())
      throw InputError(where, name + " with triangles up to " + std::to_string(std::uint64_t{s.first_triangle} + s.triangle_count),
                       "at most the mesh's " + std::to_string(plant.meshes[s.mesh].triangles.size()));
    if (!finite(s.placement)) throw InputError(where, name + " with a placement that is not finite", "finite numbers");
  }
  if (plant.facet_count() == 0) throw InputError(where, "no face", "at least one triangle or polygon");
}

Triangle shape_triangle(const Plant& plant, const Shape& shape, std::uint32_t t) {
  Triangle c = plant.meshes[shape.mesh].corners(shape.first_triangle + t);
  for (auto& p : c) p = shape.placement.point(p);
  if (shape.placement.mirrors()) std::swap(c[1], c[2]);
  return c;
}

}  // namespace sunfleck
