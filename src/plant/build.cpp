#include <sunfleck/plant/build.hpp>

#include <utility>

namespace sunfleck {

Plant empty_plant(const std::string& name, const std::string& file, const std::string& type) {
  Plant plant;
  plant.name = name;
  plant.file = file;
  add_structure(plant, no_parent, type, name);
  return plant;
}

std::uint32_t add_structure(Plant& plant, std::uint32_t parent, const std::string& type, const std::string& name) {
  Structure structure;
  structure.parent = parent;
  structure.type = plant.type_index(type);
  structure.name = name;
  plant.structures.push_back(std::move(structure));
  return static_cast<std::uint32_t>(plant.structures.size() - 1);
}

void set_attribute(Plant& plant, std::uint32_t structure, const std::string& attribute_name, AttributeValue value) {
  const std::uint32_t key = plant.attribute_index(attribute_name);
  for (auto& [k, v] : plant.structures[structure].attributes)
    if (k == key) {
      v = std::move(value);
      return;
    }
  plant.structures[structure].attributes.emplace_back(key, std::move(value));
}

void add_mesh(Plant& plant, Mesh mesh, const std::vector<std::uint32_t>& owner, const std::vector<std::uint32_t>& material) {
  const auto mesh_index = static_cast<std::uint32_t>(plant.meshes.size());
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t t = 0; t < count; ++t) {
    if (t > 0 && owner[t] == owner[t - 1] && material[t] == material[t - 1]) {
      ++plant.shapes.back().triangle_count;
      continue;
    }
    Shape shape;
    shape.structure = owner[t];
    shape.mesh = mesh_index;
    shape.first_triangle = t;
    shape.triangle_count = 1;
    shape.material = material[t];
    plant.shapes.push_back(shape);
  }
  plant.meshes.push_back(std::move(mesh));
}

Plant make_plant(std::vector<Mesh> meshes, const std::string& name, const std::string& type) {
  Plant plant = empty_plant(name);
  const std::uint32_t material = plant.material_index("");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::uint32_t organ = add_structure(plant, 0, type, meshes.size() == 1 ? name : name + "_" + std::to_string(i + 1));
    const std::size_t count = meshes[i].triangles.size();
    add_mesh(plant, std::move(meshes[i]), std::vector(count, organ), std::vector(count, material));
  }
  check_plant(plant);
  return plant;
}

Plant make_plant(Mesh mesh, const std::string& name, const std::string& type) {
  std::vector<Mesh> meshes;
  meshes.push_back(std::move(mesh));
  return make_plant(std::move(meshes), name, type);
}

}  // namespace sunfleck
