// VTKHDF (VTK 9.1 and later, ParaView 5.10 and later): an UnstructuredGrid of triangles, since that is the one that all of them read.
#include <algorithm>

#include <sunfleck/view/export.hpp>

#include "view/heavy_mesh.hpp"
#include "view/mesh_columns.hpp"

namespace sunfleck {

namespace {

using h5::Id;
using h5::RowDataset;

constexpr std::uint8_t vtk_triangle = 5;
constexpr std::size_t dataset_rows_at_once = std::size_t{1} << 18;

void check(const h5::OutputFile& file, bool good) {
  file.check(good);
}

/// VTK wants an ASCII string of fixed length.
void write_type(h5::OutputFile& file, hid_t group) {
  const std::string text = "UnstructuredGrid";
  const Id type(H5Tcopy(H5T_C_S1)), space(H5Screate(H5S_SCALAR));
  check(file, H5Tset_size(type.get(), text.size()) >= 0 && H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0);
  const Id attribute(H5Acreate2(group, "Type", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(file, attribute && H5Awrite(attribute.get(), type.get(), text.data()) >= 0);
}

void write_version(h5::OutputFile& file, hid_t group) {
  const std::int64_t version[2] = {1, 0};
  const hsize_t two = 2;
  const Id space(H5Screate_simple(1, &two, nullptr));
  const Id attribute(H5Acreate2(group, "Version", H5T_NATIVE_INT64, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  check(file, attribute && H5Awrite(attribute.get(), H5T_NATIVE_INT64, version) >= 0);
}

void write_offsets(h5::OutputFile& file, h5::ChunkQueue& queue, hid_t group, std::size_t n) {
  RowDataset offsets(file, queue, group, "Offsets", H5T_NATIVE_INT64, {0, n + 1, {}}, "row of Connectivity");
  RowDataset types(file, queue, group, "Types", H5T_NATIVE_UINT8, {0, n, {}}, "VTK cell type");
  const std::vector<std::uint8_t> triangles(std::min(n, dataset_rows_at_once), vtk_triangle);
  std::vector<std::int64_t> rows;
  for (std::size_t first = 0; first <= n; first += dataset_rows_at_once) {
    const std::size_t count = std::min(dataset_rows_at_once, n + 1 - first);
    rows.clear();
    for (std::size_t i = 0; i < count; ++i) rows.push_back(static_cast<std::int64_t>(3 * (first + i)));
    offsets.append(0, rows.data(), count);
    if (const std::size_t cells = std::min(dataset_rows_at_once, n - first); cells > 0) types.append(0, triangles.data(), cells);
  }
  offsets.finish(), types.finish();
  queue.flush();
}

/// One dataset a column; all columns of a batch are read together.
void write_values(h5::OutputFile& file, h5::ChunkQueue& queue, hid_t group, const Result& result, const LitMesh& mesh,
                  const std::vector<MeshColumn>& columns, Progress& progress, double begin, double end) {
  const std::size_t n = mesh.facet_count();
  RowDataset area(file, queue, group, "area", H5T_NATIVE_FLOAT, {0, n, {}}, "m^2");
  RowDataset organ(file, queue, group, "organ", H5T_NATIVE_UINT32, {0, n, {}}, "row of /organs");
  std::vector<RowDataset> values;
  values.reserve(columns.size());
  for (const auto& column : columns)
    values.emplace_back(file, queue, group, column.name.c_str(), H5T_NATIVE_FLOAT, RowDataset::Shape{0, n, {}}, column.unit);
  mesh.for_each_batch(progress, begin, end, [&](std::span<const PlacedPatch>, std::size_t first, std::size_t count) {
    area.append(0, result.rows<float>("facets/area", first, count).data(), count);
    organ.append(0, result.facet_organs(first, count).data(), count);
    const auto rows = column_values(result, columns, first, count);
    for (std::size_t c = 0; c < columns.size(); ++c) values[c].append(0, rows[c].data(), count);
  });
  area.finish(), organ.finish();
  for (auto& value : values) value.finish();
  queue.flush();
}

}  // namespace

void export_vtkhdf(const Result& result, const std::string& path, const MeshChoice& choice, Progress& progress) {
  const LitMesh mesh(result);
  const auto columns = mesh_columns(result, choice);
  const LitColours colours(result, mesh.geometry(), choice, progress);
  const std::size_t n = mesh.facet_count();

  const h5::Quiet quiet;
  h5::OutputFile file(path);
  {
    h5::ChunkQueue queue(file);
    const Id root = h5::make_group(file, file.id(), "VTKHDF");
    write_version(file, root.get());
    write_type(file, root.get());
    h5::ArrayWriter arrays(file, queue);
    for (const auto& [name, count] : {std::pair{"NumberOfPoints", mesh.patches().vertex_count()}, std::pair{"NumberOfCells", n},
                                      std::pair{"NumberOfConnectivityIds", 3 * n}})
      arrays.write(root.get(), name, std::vector<std::int64_t>{static_cast<std::int64_t>(count)}, "1");
    arrays.flush();
    h5::write_points(file, queue, root.get(), "Points", mesh, progress, 0.2);
    h5::write_triangles(file, queue, root.get(), "Connectivity", mesh, true, progress, 0.2, 0.4);
    write_offsets(file, queue, root.get(), n);
    const Id cells = h5::make_group(file, root.get(), "CellData");
    h5::write_colours(file, queue, cells.get(), "colour", mesh, colours, progress, 0.4, 0.6);
    write_values(file, queue, cells.get(), result, mesh, columns, progress, 0.6, 1.0);
  }
  file.commit();
}

}  // namespace sunfleck
