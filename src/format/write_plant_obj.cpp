#include <sunfleck/format/write_plant_obj.hpp>

#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/companion_file.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck {

void write_plant_obj(const Plant& plant, const std::string& file) {
  const std::string library = material_library_beside(file);
  std::string materials(material_library_mark);
  for (std::size_t m = 0; m < plant.materials.size(); ++m) {
    const double hue = 0.35 + 0.3 * static_cast<double>(m % 3);
    materials += fmt::format("newmtl {}\nKd {:.2f} 0.45 0.20\n\n", plant.materials[m].empty() ? "none" : plant.materials[m], hue);
  }
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "# {}: {} structures, {} facets\nmtllib {}\n", plant.name, plant.structures.size(), plant.facet_count(),
                 std::filesystem::path(library).filename().string());
  std::size_t first = 1;
  std::uint32_t group = no_parent, material = no_parent;
  for (const auto& shape : plant.shapes) {
    const Mesh& mesh = plant.meshes[shape.mesh];
    if (shape.structure != group) {
      group = shape.structure;
      fmt::format_to(to, "g {}_{}\n", plant.types[plant.structures[group].type], group);
    }
    if (shape.material != material) {
      material = shape.material;
      fmt::format_to(to, "usemtl {}\n", plant.materials[material].empty() ? "none" : plant.materials[material]);
    }
    for (const auto& v : mesh.vertices) {
      const Vec3 p = shape.placement.point(v);
      fmt::format_to(to, "v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    }
    const bool mirrors = shape.placement.mirrors();
    for (std::uint32_t t = shape.first_triangle; t < shape.first_triangle + shape.triangle_count; ++t) {
      const auto& c = mesh.triangles[t];
      fmt::format_to(to, "f {} {} {}\n", first + c[0], first + c[mirrors ? 2 : 1], first + c[mirrors ? 1 : 2]);
    }
    first += mesh.vertices.size();
  }
  ReplacedFile to_library(library), to_file(file);
  to_library.write(materials);
  to_file.write(out.data(), out.size());
  ReplacedFile::commit({&to_library, &to_file});
}

}  // namespace sunfleck
