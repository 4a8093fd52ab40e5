#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/lit_colours.hpp"
#include "view/lit_mesh.hpp"
#include "view/mesh_columns.hpp"

namespace sunfleck {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY rows are copied from memory as they are");

std::string header(const Result& result, const std::vector<MeshColumn>& columns, std::size_t vertices, std::size_t faces) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const auto& line : mesh_comments(result)) text += "comment " + line + "\n";
  text += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", vertices);
  text += fmt::format(
      "element face {}\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n", faces);
  text += "property float quality\nproperty int organ\nproperty float area\n";
  for (const auto& column : columns) text += "property float " + column.name + "\n";
  return text + "end_header\n";
}

}  // namespace

void export_ply(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress) {
  const LitMesh mesh(result);
  if (mesh.patches().vertex_count() > 0x7fffffffu) throw UsageError(file + ": PLY cannot hold more than 2^31 vertices");
  const auto columns = mesh_columns(result, choice);
  const LitColours colours(result, mesh.geometry(), choice, progress);

  ReplacedFile out(file);
  out.write(header(result, columns, mesh.patches().vertex_count(), mesh.facet_count()));
  mesh.for_each_batch(progress, 0.0, 0.2, [&](std::span<const PlacedPatch> batch, std::size_t, std::size_t) {
    for (const auto& placed : batch)
      for (const auto& v : placed.patch->vertices) {
        const Vec3 p = placed.map.point(v);
        out.write(&p, sizeof p);
      }
  });
  const std::size_t stride = 1 + 12 + 15 + 4 * columns.size();
  std::vector<char> rows;
  mesh.for_each_batch(progress, 0.2, 1.0, [&](std::span<const PlacedPatch> batch, std::size_t first, std::size_t count) {
    rows.assign(count * stride, 3);  // each row starts with its number of corners
    const auto put = [&](std::size_t i, std::size_t offset, const auto& value) {
      std::memcpy(&rows[i * stride + offset], &value, sizeof value);
    };
    for (const auto& placed : batch)
      for (std::size_t t = 0; t < placed.facets(); ++t) {
        auto corners = placed.triangle(t);
        for (auto& c : corners) c += static_cast<std::uint32_t>(placed.first_vertex);
        put(placed.first_facet - first + t, 1, corners);
      }
    const auto lit = colours.range(first, count);
    const auto organ = result.facet_organs(first, count);
    const auto area = result.rows<float>("facets/area", first, count);
    const auto values = column_values(result, columns, first, count);
    for (std::size_t i = 0; i < count; ++i) {
      put(i, 13, lit.colours[i]);
      put(i, 16, lit.values[i]);
      put(i, 20, static_cast<std::int32_t>(organ[i]));
      put(i, 24, area[i]);
      for (std::size_t c = 0; c < columns.size(); ++c) put(i, 28 + 4 * c, values[c][i]);
    }
    out.write(rows.data(), rows.size());
  });
  out.commit();
}

}  // namespace sunfleck
