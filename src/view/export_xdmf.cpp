// XDMF 2 for ParaView: values stay in the result file and are referred to; several lighting states become time steps.
// Where the result holds its vertices in the world already (every mesh stands where it was drawn, once), so does the mesh; else points and
// triangles are written to FILE.xdmf.h5.
#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include <sunfleck/core/companion_file.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/view/export.hpp>

#include "result/dataset_reader.hpp"
#include "view/heavy_mesh.hpp"
#include "view/mesh_columns.hpp"

namespace sunfleck {

namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : clean_name(text)) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

/// Comments of XML hold no two dashes in a row.
std::string commented(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.insert(++at, 1, ' ');
  return text;
}

struct Number {
  const char* type;
  int bytes;
};
constexpr Number float4{"Float", 4}, float8{"Float", 8}, int8{"Int", 8}, uint4{"UInt", 4}, uint1{"UChar", 1};

std::string dimensions(const std::vector<std::size_t>& dims) {
  return fmt::format("{}", fmt::join(dims, " "));
}

std::string whole(const Number& number, const std::vector<std::size_t>& dims, const std::string& place) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}</DataItem>", dimensions(dims),
                     number.type, number.bytes, escaped(place));
}

/// The block [start, start + count) of a dataset, seen with the dimensions `shown`.
std::string block(const Number& number, const std::vector<std::size_t>& dims, const std::vector<std::size_t>& start,
                  const std::vector<std::size_t>& count, const std::vector<std::size_t>& shown, const std::string& place) {
  if (start == std::vector<std::size_t>(start.size(), 0) && count == dims && shown == dims) return whole(number, dims, place);
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"{}\"><DataItem Dimensions=\"3 {}\" NumberType=\"Int\" "
      "Format=\"XML\">{} {} {}</DataItem>{}</DataItem>",
      dimensions(shown), dims.size(), dimensions(start), dimensions(std::vector<std::size_t>(dims.size(), 1)), dimensions(count),
      whole(number, dims, place));
}

/// A piece of the scene: where its points, triangles and rows of facets are.
struct Piece {
  std::string points, triangles;  ///< data items
  std::size_t first_facet, facets;
};

/// Per mesh of the result its facets, if every one stands where it was drawn: no copy is moved, no mesh is used twice or in part.
std::vector<std::array<std::size_t, 2>> meshes_in_world(const ResultGeometry& geometry) {
  const auto stays = [](const Affine& map) { return map.linear == Mat3{1.0} && map.translation == Vec3{0.0}; };
  std::vector<std::array<std::size_t, 2>> runs;
  std::set<const Plant*> seen;
  std::size_t facet = 0;
  for (const auto& copy : geometry.copies) {
    const Plant& plant = *geometry.plants[copy.plant].plant;
    if (!stays(copy.map) || !seen.insert(&plant).second) return {};
    std::uint32_t mesh = 0, next = 0;
    for (const auto& shape : plant.shapes) {
      if (next == plant.meshes[mesh].triangles.size() && shape.mesh == mesh + 1) ++mesh, next = 0;
      if (!stays(shape.placement) || shape.mesh != mesh || shape.first_triangle != next) return {};
      next += shape.triangle_count;
    }
    if (plant.meshes.empty() || mesh + 1 != plant.meshes.size() || next != plant.meshes[mesh].triangles.size()) return {};
    for (const auto& m : plant.meshes) {
      runs.push_back({facet, m.triangles.size()});
      facet += m.triangles.size();
    }
  }
  // models are stored in the order of plants: that of the copies must be the same for meshes to follow one another
  for (std::size_t c = 1; c < geometry.copies.size(); ++c)
    if (geometry.copies[c].plant <= geometry.copies[c - 1].plant) return {};
  if (geometry.copies.size() != geometry.plants.size()) return {};
  if (!geometry.ground.triangles.empty()) runs.push_back({facet, geometry.ground.triangles.size()});
  return runs;
}

constexpr std::size_t most_pieces = 64;
const std::string heavy_format = "sunfleck-xdmf";

class XdmfText {
 public:
  XdmfText(const Result& result, const MeshChoice& choice, std::string source, std::string heavy)
      : result_(result), choice_(choice), source_(std::move(source)), heavy_(std::move(heavy)) {}

  std::string write(const std::vector<Piece>& pieces, std::size_t colours) const {
    std::string text = "<?xml version=\"1.0\" ?>\n";
    for (const auto& line : mesh_comments(result_)) text += "<!-- " + commented(line) + " -->\n";
    text += "<Xdmf Version=\"2.0\">\n<Domain>\n";
    std::vector<std::size_t> states;
    for (std::size_t s = 0; s < result_.states().size(); ++s)
      if (!choice_.state || *choice_.state == s) states.push_back(s);
    if (states.size() > 1) text += "<Grid Name=\"states\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const auto s : states) {
      const std::string time = states.size() > 1 ? fmt::format("<Time Value=\"{}\" />\n", s) : "";
      const std::string name = escaped(result_.states()[s].name);
      if (pieces.size() > 1) text += fmt::format("<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n{}", name, time);
      for (std::size_t p = 0; p < pieces.size(); ++p)
        text += grid(pieces[p], s, pieces.size() > 1 ? fmt::format("{} {}", name, p) : name, pieces.size() > 1 ? "" : time, colours);
      if (pieces.size() > 1) text += "</Grid>\n";
    }
    if (states.size() > 1) text += "</Grid>\n";
    return text + "</Domain>\n</Xdmf>\n";
  }

 private:
  std::string cells(const std::string& name, const std::string& item, const char* type = "Scalar") const {
    return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">{}</Attribute>\n", escaped(name), type, item);
  }

  std::string grid(const Piece& piece, std::size_t state, const std::string& name, const std::string& time, std::size_t colours) const {
    const std::size_t n = result_.facet_count(), k = piece.facets, f = piece.first_facet;
    std::string text = fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n{}", name, time);
    text += fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>\n", k, piece.triangles);
    text += fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n", piece.points);
    if (colours > 0) text += cells("colour", block(uint1, {n, 3}, {f, 0}, {k, 3}, {k, 3}, heavy_ + ":/colour"), "Vector");
    text += cells("area", block(float4, {n}, {f}, {k}, {k}, source_ + ":/facets/area"));
    text += cells("organ", block(uint4, {n}, {f}, {k}, {k}, source_ + ":/facets/organ"));
    MeshChoice one = choice_;
    one.state = state;
    for (const auto& column : mesh_columns(result_, one)) {
      const auto dims = result_.shape(column.dataset);
      std::vector<std::size_t> start{state, f}, count{1, k};
      std::size_t rest = column.element;
      std::vector<std::size_t> inner(dims.size() - 2);
      for (std::size_t d = dims.size(); d-- > 2; rest /= dims[d]) inner[d - 2] = rest % dims[d];
      start.insert(start.end(), inner.begin(), inner.end());
      count.resize(dims.size(), 1);
      text += cells(column.name, block(float4, dims, start, count, {k}, source_ + ":/" + column.dataset));
    }
    return text + "</Grid>\n";
  }

  const Result& result_;
  const MeshChoice& choice_;
  std::string source_, heavy_;
};

}  // namespace

bool is_our_heavy_data(const std::string& file) {
  const InputRecord aside;  // looked at, not read
  try {
    const h5::DatasetReader there(file);
    if (there.has_attribute("/", "format")) return there.text_attribute("/", "format") == heavy_format;
    return there.has("colour");  // earlier versions
  } catch (const InputError&) {
    return false;
  }
}

void export_xdmf(const Result& result, const std::string& path, const MeshChoice& choice, Progress& progress) {
  const LitMesh mesh(result);
  const LitColours colours(result, mesh.geometry(), choice, progress);
  const fs::path folder = fs::absolute(fs::path(path)).parent_path();
  std::error_code ignored;
  const std::string source = fs::proximate(fs::absolute(result.file()), folder, ignored).string();
  const std::string heavy_path = heavy_data_beside(path), heavy = fs::path(heavy_path).filename().string();
  if (fs::equivalent(heavy_path, result.file(), ignored))
    throw UsageError(fmt::format("{}: its points would overwrite the result {}; expected another name", path, result.file()));
  const std::size_t n = mesh.facet_count(), v = mesh.patches().vertex_count();

  std::vector<Piece> pieces;
  const auto runs = meshes_in_world(mesh.geometry());
  if (!runs.empty() && runs.size() <= most_pieces) {
    const auto first_vertex = result.all<std::uint64_t>("geometry/mesh_first_vertex"),
               first_triangle = result.all<std::uint64_t>("geometry/mesh_first_triangle");
    const auto points = result.shape("geometry/vertices"), triangles = result.shape("geometry/triangles");
    if (first_vertex.size() == runs.size() + 1)
      for (std::size_t m = 0; m < runs.size(); ++m) {
        const std::size_t count = first_vertex[m + 1] - first_vertex[m];
        pieces.push_back(
            {block(float8, points, {first_vertex[m], 0}, {count, 3}, {count, 3}, source + ":/geometry/vertices"),
             block(uint4, triangles, {first_triangle[m], 0}, {runs[m][1], 3}, {runs[m][1], 3}, source + ":/geometry/triangles"), runs[m][0],
             runs[m][1]});
      }
  }
  ReplacedFile out(path);
  const bool own_mesh = pieces.empty();
  {
    const h5::Quiet quiet;
    h5::OutputFile file(heavy_path);
    h5::write_attribute(file, file.id(), "format", heavy_format);
    {
      h5::ChunkQueue queue(file);
      h5::write_colours(file, queue, file.id(), "colour", mesh, colours, progress, 0.0, 0.4);
      if (own_mesh) {
        h5::write_points(file, queue, file.id(), "points", mesh, progress, 0.7);
        h5::write_triangles(file, queue, file.id(), "triangles", mesh, false, progress, 0.7, 1.0);
        pieces.push_back({whole(float8, {v, 3}, heavy + ":/points"), whole(int8, {n, 3}, heavy + ":/triangles"), 0, n});
      }
    }
    out.write(XdmfText(result, choice, source, heavy).write(pieces, n));
    file.commit_with(out);
  }
}

}  // namespace sunfleck
