#include "result/read_geometry.hpp"

#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/slope.hpp>

namespace sunfleck::h5 {

namespace {

const std::string g = "geometry/";

std::vector<Affine> read_maps(const DatasetReader& reader, const std::string& name, std::size_t count) {
  reader.expect(name, {count, 3, 4});
  const auto values = reader.all<double>(name);
  std::vector<Affine> maps(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int row = 0; row < 3; ++row) {
      const double* v = &values[i * 12 + static_cast<std::size_t>(row) * 4];
      for (int column = 0; column < 3; ++column) maps[i].linear[column][row] = v[column];
      maps[i].translation[row] = v[3];
    }
  return maps;
}

/// Rising row numbers from 0 to `total`: where each part of a table begins.
std::vector<std::uint64_t> read_starts(const DatasetReader& reader, const std::string& name, std::size_t total) {
  const auto starts = reader.all<std::uint64_t>(name);
  bool good = !starts.empty() && starts.front() == 0 && starts.back() == total;
  for (std::size_t i = 1; good && i < starts.size(); ++i) good = starts[i - 1] <= starts[i];
  if (!good) reader.fail(name, "rows that do not rise from 0 to " + std::to_string(total), "the first row of each part");
  return starts;
}

template <class T>
void expect_below(const DatasetReader& reader, const std::string& name, const std::vector<T>& rows, std::size_t limit) {
  for (const auto row : rows)
    if (row >= limit) reader.fail(name, "row " + std::to_string(row), "a row below " + std::to_string(limit));
}

std::vector<Mesh> read_meshes(const DatasetReader& reader) {
  const auto vertex_shape = reader.shape(g + "vertices"), triangle_shape = reader.shape(g + "triangles");
  if (vertex_shape.size() != 2 || vertex_shape[1] != 3) reader.fail(g + "vertices", shape_text(vertex_shape), "rows of 3");
  if (triangle_shape.size() != 2 || triangle_shape[1] != 3) reader.fail(g + "triangles", shape_text(triangle_shape), "rows of 3");
  const auto vertices = reader.all<double>(g + "vertices");
  const auto triangles = reader.all<std::uint32_t>(g + "triangles");
  const auto first_vertex = read_starts(reader, g + "mesh_first_vertex", vertex_shape[0]);
  const auto first_triangle = read_starts(reader, g + "mesh_first_triangle", triangle_shape[0]);
  if (first_vertex.size() != first_triangle.size())
    reader.fail(g + "mesh_first_triangle", std::to_string(first_triangle.size()) + " rows", std::to_string(first_vertex.size()));
  std::vector<Mesh> meshes(first_vertex.size() - 1);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    meshes[m].vertices.reserve(first_vertex[m + 1] - first_vertex[m]);
    meshes[m].triangles.reserve(first_triangle[m + 1] - first_triangle[m]);
    for (auto v = first_vertex[m]; v < first_vertex[m + 1]; ++v)
      meshes[m].vertices.emplace_back(vertices[v * 3], vertices[v * 3 + 1], vertices[v * 3 + 2]);
    for (auto t = first_triangle[m]; t < first_triangle[m + 1]; ++t)
      meshes[m].triangles.push_back({triangles[t * 3], triangles[t * 3 + 1], triangles[t * 3 + 2]});
    check_mesh(meshes[m], location(reader.path(), 0, "/geometry/triangles"));
  }
  return meshes;
}

/// Attributes of structures, where the file has them (older ones do not), by row of structure_*.
struct StoredAttributes {
  std::vector<std::string> names;
  std::vector<std::vector<std::pair<std::uint32_t, AttributeValue>>> of_structure;

  StoredAttributes(const DatasetReader& reader, std::size_t structures) {
    if (!reader.has(g + "attribute_structure")) return;
    names = reader.strings(g + "attribute_name");
    const auto texts = reader.has(g + "attribute_text") ? reader.strings(g + "attribute_text") : std::vector<std::string>{};
    const auto structure = reader.all<std::uint32_t>(g + "attribute_structure");
    for (const char* name : {"attribute_key", "attribute_kind", "attribute_whole", "attribute_number"})
      reader.expect(g + name, {structure.size()});
    const auto key = reader.all<std::uint32_t>(g + "attribute_key");
    const auto kind = reader.all<std::uint8_t>(g + "attribute_kind");
    const auto whole = reader.all<std::int64_t>(g + "attribute_whole");
    const auto number = reader.all<double>(g + "attribute_number");
    expect_below(reader, g + "attribute_structure", structure, structures);
    expect_below(reader, g + "attribute_key", key, names.size());
    expect_below(reader, g + "attribute_kind", kind, std::variant_size_v<AttributeValue>);
    of_structure.resize(structures);
    for (std::size_t i = 0; i < structure.size(); ++i) {
      AttributeValue value = whole[i] != 0;
      if (kind[i] == 1) value = whole[i];
      if (kind[i] == 2) value = number[i];
      if (kind[i] == 3) {
        if (whole[i] < 0 || static_cast<std::size_t>(whole[i]) >= texts.size())
          reader.fail(g + "attribute_whole", "text " + std::to_string(whole[i]), "a row below " + std::to_string(texts.size()));
        value = texts[static_cast<std::size_t>(whole[i])];
      }
      of_structure[structure[i]].emplace_back(key[i], std::move(value));
    }
  }
};

std::vector<std::shared_ptr<const Plant>> read_models(const DatasetReader& reader, const std::vector<Mesh>& meshes) {
  const auto mesh = reader.all<std::uint32_t>(g + "shape_mesh");
  const std::size_t shapes = mesh.size();
  expect_below(reader, g + "shape_mesh", mesh, meshes.size());
  for (const char* name : {"shape_first_triangle", "shape_triangle_count", "shape_structure"}) reader.expect(g + name, {shapes});
  const auto first = reader.all<std::uint32_t>(g + "shape_first_triangle"), count = reader.all<std::uint32_t>(g + "shape_triangle_count"),
             structure = reader.all<std::uint32_t>(g + "shape_structure");
  const auto placement = read_maps(reader, g + "shape_placement", shapes);
  const auto parent = reader.all<std::uint32_t>(g + "structure_parent");
  reader.expect(g + "structure_type", {parent.size()});
  const auto type = reader.all<std::uint32_t>(g + "structure_type");
  const auto types = reader.strings(g + "structure_type_name");
  const auto model_shape = read_starts(reader, g + "model_first_shape", shapes),
             model_structure = read_starts(reader, g + "model_first_structure", parent.size());
  if (model_shape.size() != model_structure.size())
    reader.fail(g + "model_first_structure", std::to_string(model_structure.size()) + " rows", std::to_string(model_shape.size()));

  const StoredAttributes attributes(reader, parent.size());
  std::vector<std::shared_ptr<const Plant>> models;
  for (std::size_t m = 0; m + 1 < model_shape.size(); ++m) {
    auto plant = std::make_shared<Plant>();
    plant->file = location(reader.path(), 0, "/geometry");
    plant->types = types;
    plant->materials = {""};
    plant->attribute_names = attributes.names;
    for (auto s = model_structure[m]; s < model_structure[m + 1]; ++s) {
      Structure row;
      row.parent = parent[s];
      row.type = type[s];
      if (!attributes.of_structure.empty()) row.attributes = attributes.of_structure[s];
      plant->structures.push_back(row);
    }
    std::uint32_t low = 0xffffffffu, high = 0;  // the model's own meshes
    for (auto s = model_shape[m]; s < model_shape[m + 1]; ++s) low = std::min(low, mesh[s]), high = std::max(high, mesh[s]);
    if (low <= high) plant->meshes.assign(meshes.begin() + low, meshes.begin() + high + 1);
    for (auto s = model_shape[m]; s < model_shape[m + 1]; ++s)
      plant->shapes.push_back({structure[s], mesh[s] - low, first[s], count[s], 0, placement[s]});
    check_plant(*plant);
    models.push_back(std::move(plant));
  }
  return models;
}

}  // namespace

void read_slope(const DatasetReader& reader, PeriodicCell& cell) {
  const std::string name = "geometry/periodic_slope";
  if (!reader.has(name)) return;
  reader.expect(name, {2});
  const auto slope = reader.all<double>(name);
  if (!(std::hypot(slope[0], slope[1]) <= steepest_slope))
    reader.fail(name, std::to_string(slope[0]) + ", " + std::to_string(slope[1]), "a slope of at most 10");
  cell.slope_x = slope[0], cell.slope_y = slope[1];
}

ResultGeometry read_geometry(const DatasetReader& reader, std::size_t materials) {
  ResultGeometry out;
  auto meshes = read_meshes(reader);
  const auto models = read_models(reader, meshes);

  const auto names = reader.strings(g + "plant_name");
  reader.expect(g + "plant_model", {names.size()});
  const auto model = reader.all<std::uint32_t>(g + "plant_model");
  expect_below(reader, g + "plant_model", model, models.size());
  const auto optics = reader.all<std::uint32_t>(g + "plant_shape_optics");
  expect_below(reader, g + "plant_shape_optics", optics, materials);
  const auto starts = read_starts(reader, g + "plant_first_optics", optics.size());
  if (starts.size() != names.size() + 1)
    reader.fail(g + "plant_first_optics", std::to_string(starts.size()) + " rows", std::to_string(names.size() + 1));
  for (std::size_t p = 0; p < names.size(); ++p) {
    ResultGeometry::Entry entry{
        names[p],
        models[model[p]],
        {optics.begin() + static_cast<std::ptrdiff_t>(starts[p]), optics.begin() + static_cast<std::ptrdiff_t>(starts[p + 1])},
        {0}};
    if (entry.shape_optics.size() != entry.plant->shapes.size())
      reader.fail(g + "plant_first_optics", std::to_string(entry.shape_optics.size()) + " shapes",
                  std::to_string(entry.plant->shapes.size()));
    for (const auto& s : entry.plant->shapes) entry.shape_facet.push_back(entry.shape_facet.back() + s.triangle_count);
    out.plants.push_back(std::move(entry));
  }

  const auto copy_plant = reader.all<std::uint32_t>(g + "copy_plant");
  expect_below(reader, g + "copy_plant", copy_plant, names.size());
  const auto maps = read_maps(reader, g + "copy_map", copy_plant.size());
  for (std::size_t c = 0; c < copy_plant.size(); ++c) {
    out.copies.push_back({copy_plant[c], maps[c], out.plant_facets});
    out.plant_facets += out.plants[copy_plant[c]].shape_facet.back();
  }
  if (reader.count_attribute("geometry", "plant_facets") != out.plant_facets)
    reader.fail("geometry/@plant_facets", std::to_string(reader.count_attribute("geometry", "plant_facets")),
                std::to_string(out.plant_facets) + " as placed");
  if (const auto ground = reader.count_attribute("geometry", "ground_facets"); ground > 0) {
    if (meshes.empty() || meshes.back().triangles.size() != ground || materials == 0)
      reader.fail("geometry/@ground_facets", std::to_string(ground), "the triangles of the last mesh");
    out.ground = std::move(meshes.back());
    out.ground_optics = static_cast<std::uint32_t>(materials - 1);
  }
  if (reader.has(g + "periodic_cell")) {
    reader.expect(g + "periodic_cell", {4});
    const auto cell = reader.all<double>(g + "periodic_cell");
    out.periodic = PeriodicCell{cell[0], cell[1], cell[2], cell[3]};
    read_slope(reader, *out.periodic);
  }
  return out;
}

}  // namespace sunfleck::h5
