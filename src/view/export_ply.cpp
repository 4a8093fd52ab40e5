#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <functional>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/lit_colours.hpp"
#include "view/shared_vertices.hpp"

namespace sunfleck {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY rows are copied from memory as they are");

constexpr std::size_t facets_at_once = std::size_t{1} << 16;

/// PLY names hold no blanks.
std::string property_name(const std::string& text) {
  std::string name;
  for (const char c : text) name += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-' || c == ':' ? c : '_';
  return name;
}

/// Float columns of faces, taken from one dataset [states][n][width].
struct Column {
  std::string name;
  std::string dataset;
  std::size_t state, width, element;
};

std::vector<Column> columns_of(const Result& result, const MeshChoice& choice) {
  std::vector<Column> columns;
  const std::size_t bands = result.bands().size();
  for (std::size_t s = 0; s < result.states().size(); ++s) {
    if (choice.state && *choice.state != s) continue;
    const std::string suffix = !choice.state && result.states().size() > 1 ? "_" + result.states()[s].name : "";
    const auto add = [&](const std::string& name, const char* dataset, std::size_t width, std::size_t element) {
      if (result.has(dataset)) columns.push_back({property_name(name + suffix), dataset, s, width, element});
    };
    for (std::size_t b = 0; b < bands; ++b) {
      const std::string& band = result.bands()[b];
      add("irradiance_front_" + band, "facets/irradiance", 2 * bands, b);
      add("irradiance_back_" + band, "facets/irradiance", 2 * bands, bands + b);
      add("absorbed_" + band, "facets/absorbed", bands, b);
    }
    add("sunlit_front", "facets/sunlit", 2, 0);
    add("sunlit_back", "facets/sunlit", 2, 1);
  }
  return columns;
}

std::string header(const Result& result, const std::vector<Column>& columns, std::size_t vertices, std::size_t faces) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += fmt::format("comment Sunfleck {}, method {}; one face a facet; lengths in m\n", result.header().software_version,
                      result.header().method);
  for (std::size_t b = 0; b < result.bands().size(); ++b)
    text += fmt::format("comment irradiance and absorbed {}: {} of one-sided area\n", result.bands()[b], result.band_units()[b]);
  text += "comment sunlit: fraction of the side that the sun reaches; organ: row of /organs of the result\n";
  text += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", vertices);
  text += fmt::format(
      "element face {}\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n", faces);
  text += "property float quality\nproperty int organ\nproperty float area\n";
  for (const auto& column : columns) text += "property float " + column.name + "\n";
  return text + "end_header\n";
}

void write_vertices(ReplacedFile& out, const ResultGeometry& geometry, const SharedVertices& shared, Progress& progress) {
  for (const auto& copy : geometry.copies) {
    progress.check();
    const Plant& plant = *geometry.plants[copy.plant].plant;
    const auto& pieces = shared.pieces(copy.plant);
    for (std::size_t s = 0; s < pieces.size(); ++s) {
      const Affine to_world = copy.map * plant.shapes[s].placement;
      for (const auto v : pieces[s].vertices) {
        const Vec3 p = to_world.point(plant.meshes[plant.shapes[s].mesh].vertices[v]);
        out.write(&p, sizeof p);
      }
    }
  }
  for (const Vec3& p : geometry.ground.vertices) out.write(&p, sizeof p);
}

/// Calls face(vertex rows) for every facet, in order.
void for_each_face(const ResultGeometry& geometry, const SharedVertices& shared,
                   const std::function<void(const std::array<std::uint32_t, 3>&)>& face) {
  std::uint32_t base = 0;
  for (const auto& copy : geometry.copies) {
    const Plant& plant = *geometry.plants[copy.plant].plant;
    const auto& pieces = shared.pieces(copy.plant);
    for (std::size_t s = 0; s < pieces.size(); ++s) {
      const bool mirrors = (copy.map * plant.shapes[s].placement).mirrors();
      for (auto t : pieces[s].triangles) {
        if (mirrors) std::swap(t[1], t[2]);
        face({base + t[0], base + t[1], base + t[2]});
      }
      base += static_cast<std::uint32_t>(pieces[s].vertices.size());
    }
  }
  for (const auto& t : geometry.ground.triangles) face({base + t[0], base + t[1], base + t[2]});
}

/// Rows of faces of [first, first + count) without their vertices, `stride` bytes each.
std::vector<char> face_values(const Result& result, const LitColours& colours, const std::vector<Column>& columns, std::size_t first,
                              std::size_t count, std::size_t stride) {
  std::vector<char> rows(count * stride);
  const auto put = [&](std::size_t i, std::size_t offset, const auto& value) {
    std::memcpy(&rows[i * stride + offset], &value, sizeof value);
  };
  const auto lit = colours.range(first, count);
  const auto organ = result.facet_organs(first, count);
  const auto area = result.rows<float>("facets/area", first, count);
  for (std::size_t i = 0; i < count; ++i) {
    put(i, 0, lit.colours[i]);
    put(i, 3, lit.values[i]);
    put(i, 7, static_cast<std::int32_t>(organ[i]));
    put(i, 11, area[i]);
  }
  std::vector<float> values;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto& column = columns[c];
    const bool same = c > 0 && columns[c - 1].dataset == column.dataset && columns[c - 1].state == column.state;
    if (!same) values = result.state_rows<float>(column.dataset, column.state, first, count);
    for (std::size_t i = 0; i < count; ++i) put(i, 15 + 4 * c, values[i * column.width + column.element]);
  }
  return rows;
}

}  // namespace

void export_ply(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress) {
  if (!result.has("facets/area"))
    throw InputError(location(result.file(), 0, "/facets"), "nothing",
                     "values per facet; the scene kept organs only ([output] facets = false)");
  const ResultGeometry geometry = result.geometry();
  const SharedVertices shared(geometry);
  const std::size_t n = geometry.facet_count();
  if (shared.vertex_count() > 0x7fffffffu) throw UsageError(file + ": PLY cannot hold more than 2^31 vertices");
  const auto columns = columns_of(result, choice);
  const LitColours colours(result, geometry, choice, progress);

  ReplacedFile out(file);
  out.write(header(result, columns, shared.vertex_count(), n));
  write_vertices(out, geometry, shared, progress);
  const std::size_t stride = 15 + 4 * columns.size();
  std::vector<char> rows;
  std::size_t facet = 0;
  for_each_face(geometry, shared, [&](const std::array<std::uint32_t, 3>& corners) {
    if (facet % facets_at_once == 0) {
      progress.check();
      progress.fraction("export", static_cast<double>(facet) / static_cast<double>(n));
      rows = face_values(result, colours, columns, facet, std::min(facets_at_once, n - facet), stride);
    }
    const char three = 3;
    out.write(&three, 1);
    out.write(corners.data(), sizeof corners);
    out.write(&rows[(facet % facets_at_once) * stride], stride);
    ++facet;
  });
  out.commit();
}

}  // namespace sunfleck
