#include <map>
#include <unordered_map>
#include <variant>

#include "result/describe_scene.hpp"

namespace sunfleck::h5 {

namespace {

void push(std::vector<double>& rows, const Affine& map) {  // row major [linear | translation]
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows.push_back(map.linear[column][row]);
    rows.push_back(map.translation[row]);
  }
}

/// All meshes end to end, with where each begins.
struct Meshes {
  std::vector<double> vertices;
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint64_t> first_vertex{0}, first_triangle{0};

  void add(const Mesh& mesh) {
    for (const auto& v : mesh.vertices) vertices.insert(vertices.end(), {v.x, v.y, v.z});
    for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    first_vertex.push_back(vertices.size() / 3);
    first_triangle.push_back(triangles.size() / 3);
  }
};

/// Attributes of the structures of all models, as in our plant files (docs/formats-plants.md).
struct Attributes {
  std::vector<std::string> names, texts;
  std::map<std::string, std::uint32_t> name_rows, text_rows;
  std::vector<std::uint32_t> structure, key;
  std::vector<std::uint8_t> kind;
  std::vector<std::int64_t> whole;
  std::vector<double> number;

  static std::uint32_t row(const std::string& text, std::vector<std::string>& table, std::map<std::string, std::uint32_t>& rows) {
    const auto [place, added] = rows.try_emplace(text, static_cast<std::uint32_t>(table.size()));
    if (added) table.push_back(text);
    return place->second;
  }

  void add(const Plant& plant, std::size_t first_structure) {
    for (std::size_t s = 0; s < plant.structures.size(); ++s)
      for (const auto& [name, value] : plant.structures[s].attributes) {
        structure.push_back(static_cast<std::uint32_t>(first_structure + s));
        key.push_back(row(plant.attribute_names[name], names, name_rows));
        kind.push_back(static_cast<std::uint8_t>(value.index()));
        whole.push_back(0), number.push_back(0.0);
        if (const auto* truth = std::get_if<bool>(&value)) whole.back() = *truth;
        if (const auto* i = std::get_if<std::int64_t>(&value)) whole.back() = *i;
        if (const auto* d = std::get_if<double>(&value)) number.back() = *d;
        if (const auto* t = std::get_if<std::string>(&value)) whole.back() = row(*t, texts, text_rows);
      }
  }
};

/// Cells of flat ground with shared corners, numbered as they are first met: two rows of corners are known at a time.
Mesh flat_ground_mesh(const GroundFacets& facets) {
  constexpr std::uint32_t unknown = 0xffffffffu;
  const std::size_t columns = facets.cells()[0];
  Mesh mesh;
  mesh.triangles.reserve(facets.size());
  mesh.vertices.reserve((columns + 1) * (std::size_t{facets.cells()[1]} + 1));
  std::vector<std::uint32_t> below(columns + 1, unknown), above(columns + 1, unknown);
  const auto vertex = [&](std::uint32_t& known, const Vec3& p) {
    if (known == unknown) {
      known = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(p);
    }
    return known;
  };
  for (std::size_t f = 0; f < facets.size(); f += 2) {
    const std::size_t i = f / 2 % columns;
    if (f > 0 && i == 0) {
      below.swap(above);
      std::fill(above.begin(), above.end(), unknown);
    }
    const Triangle low = facets[f], high = facets[f + 1];
    const auto a = vertex(below[i], low[0]), b = vertex(below[i + 1], low[1]), c = vertex(above[i + 1], low[2]);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, vertex(above[i], high[2])});
  }
  return mesh;
}

/// Ground facets with shared corners.
Mesh ground_mesh(const GroundFacets& facets) {
  if (facets.cells()[0] > 0) return flat_ground_mesh(facets);
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::size_t h = 0;
      for (const double x : p) h = h * 1000003u ^ std::hash<double>{}(x);
      return h;
    }
  };
  Mesh mesh;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> known;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Triangle corners = facets[f];
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = corners[c];
      const auto [place, added] = known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(p);
      triangle[c] = place->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

void write_geometry(OutputFile& file, ArrayWriter& arrays, const Scene& scene, const PlacedScene& placed) {
  Meshes meshes;
  std::map<const Plant*, std::uint32_t> model_of;
  std::vector<std::string> types, plant_names;
  std::map<std::string, std::uint32_t> type_rows;
  std::vector<std::uint32_t> shape_mesh, shape_first, shape_count, shape_structure, structure_parent, structure_type, plant_model,
      plant_optics;
  std::vector<double> shape_placement, copy_map;
  Attributes attributes;
  std::vector<std::uint64_t> model_first_shape{0}, model_first_structure{0}, plant_first_optics{0}, copy_first_facet;

  for (const auto& entry : scene.plants) {
    const Plant& plant = *entry.plant;
    const auto [place, added] = model_of.try_emplace(&plant, static_cast<std::uint32_t>(model_of.size()));
    if (added) {
      const auto first_mesh = static_cast<std::uint32_t>(meshes.first_vertex.size() - 1);
      for (const auto& mesh : plant.meshes) meshes.add(mesh);
      for (const auto& s : plant.shapes) {
        shape_mesh.push_back(first_mesh + s.mesh);
        shape_first.push_back(s.first_triangle);
        shape_count.push_back(s.triangle_count);
        shape_structure.push_back(s.structure);
        push(shape_placement, s.placement);
      }
      attributes.add(plant, structure_parent.size());
      for (const auto& s : plant.structures) {
        const auto [row, fresh] = type_rows.try_emplace(plant.types[s.type], static_cast<std::uint32_t>(types.size()));
        if (fresh) types.push_back(plant.types[s.type]);
        structure_parent.push_back(s.parent);
        structure_type.push_back(row->second);
      }
      model_first_shape.push_back(shape_mesh.size());
      model_first_structure.push_back(structure_parent.size());
    }
    plant_names.push_back(entry.name);
    plant_model.push_back(place->second);
    plant_optics.insert(plant_optics.end(), entry.shape_optics.begin(), entry.shape_optics.end());
    plant_first_optics.push_back(plant_optics.size());
  }
  std::vector<std::uint32_t> copy_plant;
  for (const auto& copy : placed.copies) {
    push(copy_map, copy.map);
    copy_plant.push_back(copy.plant);
    copy_first_facet.push_back(copy.first_facet);
  }
  if (!placed.ground.empty()) meshes.add(ground_mesh(placed.ground));  // the last mesh

  const Id group = make_group(file, file.id(), "geometry");
  const hid_t g = group.get();
  arrays.write(g, "vertices", meshes.vertices.data(), {meshes.vertices.size() / 3, 3}, "m");
  arrays.write(g, "triangles", meshes.triangles.data(), {meshes.triangles.size() / 3, 3}, "vertex of the mesh");
  arrays.write(g, "mesh_first_vertex", meshes.first_vertex, "row of vertices");
  arrays.write(g, "mesh_first_triangle", meshes.first_triangle, "row of triangles");
  arrays.write(g, "shape_mesh", shape_mesh, "mesh");
  arrays.write(g, "shape_first_triangle", shape_first, "triangle of the mesh");
  arrays.write(g, "shape_triangle_count", shape_count, "1");
  arrays.write(g, "shape_structure", shape_structure, "structure of the model");
  arrays.write(g, "shape_placement", shape_placement.data(), {shape_mesh.size(), 3, 4}, "m");
  arrays.write(g, "structure_parent", structure_parent, "structure of the model, 4294967295 = none");
  arrays.write(g, "structure_type", structure_type, "row of structure_type_name");
  arrays.write_strings(g, "structure_type_name", types);
  if (!attributes.structure.empty()) {
    arrays.write_strings(g, "attribute_name", attributes.names);
    if (!attributes.texts.empty()) arrays.write_strings(g, "attribute_text", attributes.texts);
    arrays.write(g, "attribute_structure", attributes.structure, "row of structure_*");
    arrays.write(g, "attribute_key", attributes.key, "row of attribute_name");
    arrays.write(g, "attribute_kind", attributes.kind, "0 truth, 1 whole number, 2 number, 3 text");
    arrays.write(g, "attribute_whole", attributes.whole, "as the plant file has it; of a text, row of attribute_text");
    arrays.write(g, "attribute_number", attributes.number, "as the plant file has it");
  }
  arrays.write(g, "model_first_shape", model_first_shape, "row of shape_*");
  arrays.write(g, "model_first_structure", model_first_structure, "row of structure_*");
  arrays.write_strings(g, "plant_name", plant_names);
  arrays.write(g, "plant_model", plant_model, "model");
  arrays.write(g, "plant_first_optics", plant_first_optics, "row of plant_shape_optics");
  arrays.write(g, "plant_shape_optics", plant_optics, "row of /optics");
  arrays.write(g, "copy_plant", copy_plant, "row of plant_name");
  arrays.write(g, "copy_map", copy_map.data(), {placed.copies.size(), 3, 4}, "m");
  arrays.write(g, "copy_first_facet", copy_first_facet, "row of /facets");
  const std::vector<double> cell =
      scene.periodic ? std::vector<double>{scene.periodic->x_low, scene.periodic->y_low, scene.periodic->x_high, scene.periodic->y_high}
                     : std::vector<double>{};
  if (scene.periodic) arrays.write(g, "periodic_cell", cell, "m");
  if (scene.periodic && !scene.periodic->is_level())
    arrays.write(g, "periodic_slope", std::vector<double>{scene.periodic->slope_x, scene.periodic->slope_y}, "1");
  write_attribute(file, g, "plant_facets", placed.first_ground_facet);
  write_attribute(file, g, "ground_facets", std::uint64_t{placed.ground.size()});
  arrays.flush();
}

}  // namespace sunfleck::h5
