// Wavefront OBJ with colours at the vertices ("v x y z r g b", as MeshLab, Blender and ParaView read them) and a material library.
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include <sunfleck/core/companion_file.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include "view/column_names.hpp"
#include "view/lit_colours.hpp"
#include "view/lit_mesh.hpp"
#include "view/mesh_columns.hpp"

namespace sunfleck {

namespace {

/// Mean colour of the facets of each material, as display values.
class MeanColours {
 public:
  explicit MeanColours(std::size_t materials) : sum_(materials, glm::dvec3{0.0}), count_(materials, 0.0) {}
  void add(std::uint32_t material, const Rgb8& colour) {
    sum_[material] += glm::dvec3(decode_srgb(colour));
    count_[material] += 1.0;
  }
  bool used(std::size_t material) const { return count_[material] > 0; }
  Rgb8 mean(std::size_t material) const { return encode_srgb(Rgb(sum_[material] / std::max(1.0, count_[material]))); }

 private:
  std::vector<glm::dvec3> sum_;
  std::vector<double> count_;
};

/// What the library calls materials.
std::vector<std::string> material_names(const std::vector<Optics>& materials) {
  std::vector<std::string> names;
  for (const auto& m : materials) names.push_back(m.name);
  return distinct_names(names, plain_name);
}

std::string material_text(const std::vector<std::string>& names, const MeanColours& colours) {
  std::string text = "# Colours are means over the facets; the mesh has its own at the vertices.\n";
  for (std::size_t m = 0; m < names.size(); ++m) {
    if (!colours.used(m)) continue;
    const auto c = colours.mean(m);
    text += fmt::format("newmtl {}\nKd {:.6g} {:.6g} {:.6g}\nKa 0 0 0\nKs 0 0 0\nd 1\nillum 1\n", names[m], c[0] / 255.0, c[1] / 255.0,
                        c[2] / 255.0);
  }
  return text;
}

}  // namespace

void export_obj(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress) {
  const LitMesh mesh(result);
  const LitColours colours(result, mesh.geometry(), choice, progress);
  const auto materials = material_names(result.materials());
  const std::string library = material_library_beside(file);

  ReplacedFile out(file), out_library(library);
  MeanColours means(materials.size());
  fmt::memory_buffer text;
  const auto put = std::back_inserter(text);
  for (const auto& line : mesh_comments(result)) fmt::format_to(put, "# {}\n", line);
  fmt::format_to(put, "# vertex colours: {}; groups organ_N: row N of /organs\n", choice.quantity);
  fmt::format_to(put, "mtllib {}\n", std::filesystem::path(library).filename().string());

  std::size_t copy = mesh.geometry().copies.size() + 1, vertex = 1;
  std::uint32_t organ = 0, material = 0;
  bool grouped = false;
  mesh.for_each_batch(progress, 0.0, 1.0, [&](std::span<const PlacedPatch> batch, std::size_t first, std::size_t count) {
    const auto shades = colours.shades(first, count);
    const auto area = result.rows<float>("facets/area", first, count);
    const auto organs = result.facet_organs(first, count), optics = mesh.geometry().optics(first, count);
    const std::size_t w = colours.width();
    for (std::size_t i = 0; i < count; ++i) means.add(optics[i], colours.colour(&shades[w * i]));
    for (const auto& placed : batch) {
      if (placed.copy != copy) {
        copy = placed.copy;
        fmt::format_to(put, "o {}\n", plain_name(copy == mesh.geometry().copies.size() ? "ground" : fmt::format("copy_{}", copy)));
      }
      const std::size_t at = placed.first_facet - first;
      const auto means_at_vertices = placed.patch->vertex_means(&shades[w * at], w, &area[at]);
      for (std::size_t v = 0; v < placed.patch->vertices.size(); ++v) {
        const Vec3 p = placed.map.point(placed.patch->vertices[v]);
        const auto c = colours.colour(&means_at_vertices[w * v]);
        fmt::format_to(put, "v {} {} {} {:.6g} {:.6g} {:.6g}\n", p.x, p.y, p.z, c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
      }
      for (std::size_t t = 0; t < placed.facets(); ++t) {
        if (!grouped || organs[at + t] != organ) fmt::format_to(put, "g organ_{}\n", organ = organs[at + t]);
        if (!grouped || optics[at + t] != material) fmt::format_to(put, "usemtl {}\n", materials[material = optics[at + t]]);
        grouped = true;
        const auto corners = placed.triangle(t);
        fmt::format_to(put, "f {} {} {}\n", vertex + corners[0], vertex + corners[1], vertex + corners[2]);
      }
      vertex += placed.patch->vertices.size();
    }
    out.write(text.data(), text.size());
    text.clear();
  });
  out_library.write(std::string(material_library_mark) + material_text(materials, means));
  ReplacedFile::commit({&out_library, &out});
}

}  // namespace sunfleck
