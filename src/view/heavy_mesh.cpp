#include "view/heavy_mesh.hpp"

namespace sunfleck::h5 {

void write_points(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, Progress& progress, double end) {
  RowDataset points(file, queue, group, name, H5T_NATIVE_DOUBLE, {0, mesh.patches().vertex_count(), {3}}, "m");
  std::vector<Vec3> rows;
  mesh.for_each_batch(progress, 0.0, end, [&](std::span<const PlacedPatch> batch, std::size_t, std::size_t) {
    rows.clear();
    for (const auto& placed : batch)
      for (const auto& v : placed.patch->vertices) rows.push_back(placed.map.point(v));
    points.append(0, rows.data(), rows.size());
  });
  points.finish();
  queue.flush();
}

void write_triangles(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, bool flat, Progress& progress,
                     double begin, double end) {
  const std::size_t n = mesh.facet_count();
  RowDataset triangles(file, queue, group, name, H5T_NATIVE_INT64, flat ? RowDataset::Shape{0, 3 * n, {}} : RowDataset::Shape{0, n, {3}},
                       "point");
  std::vector<std::int64_t> rows;
  mesh.for_each_batch(progress, begin, end, [&](std::span<const PlacedPatch> batch, std::size_t, std::size_t count) {
    rows.clear();
    for (const auto& placed : batch)
      for (std::size_t t = 0; t < placed.facets(); ++t)
        for (const auto corner : placed.triangle(t)) rows.push_back(static_cast<std::int64_t>(placed.first_vertex + corner));
    triangles.append(0, rows.data(), flat ? 3 * count : count);
  });
  triangles.finish();
  queue.flush();
}

void write_colours(OutputFile& file, ChunkQueue& queue, hid_t group, const char* name, const LitMesh& mesh, const LitColours& colours,
                   Progress& progress, double begin, double end) {
  RowDataset dataset(file, queue, group, name, H5T_NATIVE_UINT8, {0, mesh.facet_count(), {3}}, "sRGB code");
  mesh.for_each_batch(progress, begin, end, [&](std::span<const PlacedPatch>, std::size_t first, std::size_t count) {
    dataset.append(0, colours.range(first, count).colours.data(), count);
  });
  dataset.finish();
  queue.flush();
}

}  // namespace sunfleck::h5
