// Binary glTF 2.0 (Khronos): colours at the vertices, lit already (KHR_materials_unlit). Copies of a plant with the same colours are one
// mesh and EXT_mesh_gpu_instancing; the others have meshes of their own. Written front to back: sizes are known before the first byte.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/view/export.hpp>

#include "view/lit_colours.hpp"
#include "view/lit_mesh.hpp"

namespace sunfleck {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

using Json = nlohmann::ordered_json;

constexpr std::size_t most_lone_meshes = 4096;  ///< beyond it, neighbouring copies share a mesh
constexpr double far_away = 1000.0;             ///< [m] from where single precision wants coordinates about a centre of their own

enum : int { float_type = 5126, ushort_type = 5123, uint_type = 5125, array_buffer = 34962, index_buffer = 34963 };

/// Turn, uniform scale and mirror of a copy; none where its map is something else.
struct Instance {
  glm::dquat turn{1, 0, 0, 0};
  double scale = 1;
  bool mirror = false;
};

std::optional<Instance> instance_of(const Affine& map) {
  const double s = std::cbrt(std::fabs(glm::determinant(map.linear)));
  if (!(s > 0) || !std::isfinite(s)) return std::nullopt;
  Mat3 m = map.linear * (1.0 / s);
  const bool mirror = map.mirrors();
  if (mirror) m[0] = -m[0];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::fabs(glm::dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)) > 1e-9) return std::nullopt;
  return Instance{glm::normalize(glm::quat_cast(m)), s, mirror};
}

/// A mesh of the file: one set of colours for several copies, or some consecutive copies (or the ground) written out in the world.
struct GlbMesh {
  std::vector<std::size_t> copies;
  bool shared = false;
  Box box;  ///< of what is written: plant frame where shared, else world
  std::size_t vertices = 0, triangles = 0;
  std::size_t stride() const { return shared ? 20 : 24; }  ///< position, colour, value
  std::size_t vertex_bytes() const { return vertices * stride(); }
  std::size_t index_bytes() const { return triangles * 12; }
  std::size_t instance_bytes() const { return shared ? copies.size() * 40 : 0; }
};

class GlbWriter {
 public:
  GlbWriter(const Result& result, const MeshChoice& choice, Progress& progress)
      : result_(result),
        choice_(choice),
        progress_(progress),
        mesh_(result),
        colours_(result, mesh_.geometry(), choice, progress),
        placements_(result.strings("names/placement")) {}

  void write(const std::string& path) {
    group();
    find_centre();
    const std::string json = padded(describe().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), ' ');
    std::size_t bin = 0;
    for (const auto& m : meshes_) bin += m.vertex_bytes() + m.index_bytes() + m.instance_bytes();
    const std::size_t total = 12 + 8 + json.size() + 8 + bin;
    if (total > 0xffffffffu)
      throw UsageError(
          fmt::format("{}: found {:.1f} GB; a .glb holds at most 4.29 GB. Expected .vtkhdf, .xdmf or .ply, or --quantity type or "
                      "optics, under which copies share one mesh",
                      path, static_cast<double>(total) * 1e-9));
    ReplacedFile out(path);
    const auto number = [&](std::size_t value) {
      const auto n = static_cast<std::uint32_t>(value);
      out.write(&n, 4);
    };
    out.write("glTF"), number(2), number(total);
    number(json.size()), out.write("JSON"), out.write(json);
    number(bin), out.write(std::string_view("BIN\0", 4));
    for (const auto& m : meshes_) write_mesh(out, m);
    out.commit();
  }

 private:
  const ResultGeometry& geometry() const { return mesh_.geometry(); }

  static std::string padded(std::string text, char with) {
    while (text.size() % 4 != 0) text += with;
    return text;
  }

  struct Colours {
    std::vector<Rgb8> colours;
    std::vector<float> values;
  };
  /// Colours at the vertices of a patch.
  Colours colours_of(const PlacedPatch& placed, const std::vector<float>& shades, const std::vector<float>& area, std::size_t at) const {
    const std::size_t w = colours_.width();
    const auto means = placed.patch->vertex_means(&shades[w * at], w, &area[at]);
    Colours out;
    for (std::size_t v = 0; v < placed.patch->vertices.size(); ++v) {
      out.colours.push_back(colours_.colour(&means[w * v]));
      out.values.push_back(means[w * v + w - 1]);
    }
    return out;
  }

  /// Which copies share colours: by two 64-bit sums of the colours of each.
  void group() {
    const std::size_t copies = geometry().copies.size();
    std::vector<std::array<std::uint64_t, 2>> sums(copies + 1, {0, 1});
    std::vector<Box> boxes(copies + 1);
    mesh_.for_each_batch(progress_, 0.0, 0.4, [&](std::span<const PlacedPatch> batch, std::size_t first, std::size_t count) {
      const auto shades = colours_.shades(first, count);
      const auto area = result_.rows<float>("facets/area", first, count);
      for (const auto& placed : batch) {
        for (const auto& v : placed.patch->vertices) boxes[placed.copy].add(placed.map.point(v));
        auto& sum = sums[placed.copy];
        for (const auto& c : colours_of(placed, shades, area, placed.first_facet - first).colours) {
          const auto code = std::uint64_t{c[0]} | std::uint64_t{c[1]} << 8 | std::uint64_t{c[2]} << 16;
          sum = {mix(sum[0], code), mix(code, sum[1] + 1)};
        }
      }
    });
    std::map<std::tuple<std::uint32_t, std::uint64_t, std::uint64_t>, std::size_t> alike;
    std::vector<bool> lone(copies, true);
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t c = 0; c < copies; ++c) {
      if (!instance_of(geometry().copies[c].map)) continue;
      const auto [place, added] = alike.try_emplace({geometry().copies[c].plant, sums[c][0], sums[c][1]}, groups.size());
      if (added) groups.emplace_back();
      groups[place->second].push_back(c);
    }
    for (const auto& members : groups) {
      if (members.size() < 2) continue;
      GlbMesh m;
      m.copies = members, m.shared = true;
      for (const auto& placed : mesh_.patches().of_copy(members[0])) {
        const Affine to_plant = patch_to_plant(placed, geometry().copies[members[0]].map);
        for (const auto& v : placed.patch->vertices) m.box.add(to_plant.point(v));
        m.triangles += placed.facets();
      }
      m.vertices = mesh_.patches().plant_vertices(geometry().copies[members[0]].plant);
      for (const auto c : members) lone[c] = false;
      meshes_.push_back(std::move(m));
    }
    const std::size_t enough = mesh_.facet_count() / most_lone_meshes;
    bool open = false;
    for (std::size_t c = 0; c <= copies; ++c) {
      const bool ground = c == copies;
      if (ground ? geometry().ground.triangles.empty() : !lone[c]) {
        open = false;
        continue;
      }
      if (!open || ground || meshes_.back().triangles >= enough) meshes_.emplace_back();
      open = true;
      auto& m = meshes_.back();
      m.copies.push_back(c);
      m.box.add(boxes[c]);
      m.vertices += ground ? mesh_.patches().ground_vertices() : mesh_.patches().plant_vertices(geometry().copies[c].plant);
      m.triangles += ground ? geometry().ground.triangles.size() : geometry().plants[geometry().copies[c].plant].shape_facet.back();
    }
  }

  /// Patches of shared meshes are written in the plant's frame.
  static Affine patch_to_plant(const PlacedPatch& placed, const Affine& copy) {
    const Mat3 back = glm::inverse(copy.linear);
    return {back * placed.map.linear, back * (placed.map.translation - copy.translation)};
  }

  void find_centre() {
    Box box;
    for (const auto& m : meshes_) {
      if (!m.shared) box.add(m.box);
      for (const auto c : m.copies)
        if (m.shared) box.add(geometry().copies[c].map.translation);
    }
    if (!box.empty() && glm::length(box.centre()) > far_away) centre_ = glm::floor(box.centre());
  }

  Json describe() const {
    Json views = Json::array(), accessors = Json::array(), meshes = Json::array(), nodes = Json::array(), children = Json::array();
    std::size_t offset = 0;
    const auto view = [&](std::size_t bytes, std::size_t stride, int target) {
      Json v{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
      if (stride > 0) v["byteStride"] = stride;
      if (target > 0) v["target"] = target;
      views.push_back(std::move(v));
      offset += bytes;
      return views.size() - 1;
    };
    const auto accessor = [&](std::size_t in, std::size_t at, int component, std::size_t count, const char* type) {
      accessors.push_back({{"bufferView", in}, {"byteOffset", at}, {"componentType", component}, {"count", count}, {"type", type}});
      return accessors.size() - 1;
    };
    nodes.push_back(Json::object());  // the root, filled below
    bool instancing = false;
    for (const auto& m : meshes_) {
      const Vec3 from = m.shared ? Vec3{0.0} : centre_;
      const auto rows = view(m.vertex_bytes(), m.stride(), array_buffer);
      Json attributes;
      const auto position = accessor(rows, 0, float_type, m.vertices, "VEC3");
      const auto bound = [&](const Vec3& p) {
        return Json::array({static_cast<float>(p.x - from.x), static_cast<float>(p.y - from.y), static_cast<float>(p.z - from.z)});
      };
      accessors[position]["min"] = bound(m.box.low), accessors[position]["max"] = bound(m.box.high);
      attributes["POSITION"] = position;
      const auto colour = accessor(rows, 12, ushort_type, m.vertices, "VEC4");
      accessors[colour]["normalized"] = true;
      attributes["COLOR_0"] = colour;
      if (!m.shared) attributes["_VALUE"] = accessor(rows, 20, float_type, m.vertices, "SCALAR");
      const auto indices = accessor(view(m.index_bytes(), 0, index_buffer), 0, uint_type, 3 * m.triangles, "SCALAR");
      Json primitive{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
      const std::string name = name_of(m);
      meshes.push_back({{"name", name}, {"primitives", Json::array({primitive})}});
      Json node{{"name", name}, {"mesh", meshes.size() - 1}};
      if (m.shared) {
        const auto places = view(m.instance_bytes(), 0, 0);
        const std::size_t k = m.copies.size();
        node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", accessor(places, 0, float_type, k, "VEC3")},
                                                                       {"ROTATION", accessor(places, 12 * k, float_type, k, "VEC4")},
                                                                       {"SCALE", accessor(places, 28 * k, float_type, k, "VEC3")}};
        instancing = true;
      }
      nodes.push_back(std::move(node));
      children.push_back(nodes.size() - 1);
    }
    // z up and x east become glTF's y up: a quarter turn about x
    nodes[0] = {{"name", "sunfleck"}, {"rotation", {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}, {"children", children}};
    nodes[0]["translation"] = {centre_.x, centre_.z, -centre_.y};
    Json extensions = Json::array({"KHR_materials_unlit"});
    if (instancing) extensions.push_back("EXT_mesh_gpu_instancing");
    Json out{{"asset", {{"version", "2.0"}, {"generator", "Sunfleck " + software_version()}}},
             {"extensionsUsed", extensions},
             {"scene", 0},
             {"scenes", Json::array({{{"name", "sunfleck"}, {"nodes", {0}}}})},
             {"nodes", nodes},
             {"meshes", meshes},
             {"materials", Json::array({{{"name", "lit"},
                                         {"doubleSided", true},
                                         {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
                                         {"extensions", {{"KHR_materials_unlit", Json::object()}}}}})},
             {"accessors", accessors},
             {"bufferViews", views},
             {"buffers", Json::array({{{"byteLength", offset}}})}};
    if (instancing) out["extensionsRequired"] = Json::array({"EXT_mesh_gpu_instancing"});
    auto& extras = out["extras"];
    extras = {{"quantity", choice_.quantity}, {"value", colours_.quantity()}, {"unit", colours_.unit()}};
    if (!colours_.named()) extras["band"] = result_.bands()[choice_.band];
    if (colours_.named()) extras["names"] = colours_.names();
    extras["state"] = result_.states()[choice_.state.value_or(0)].name;
    return out;
  }

  std::string name_of(const GlbMesh& m) const {
    if (m.shared) return fmt::format("{} x {}", geometry().plants[geometry().copies[m.copies[0]].plant].name, m.copies.size());
    const std::string first = placement_name(result_, geometry(), placements_, m.copies.front());
    return m.copies.size() == 1 ? first : first + " to " + placement_name(result_, geometry(), placements_, m.copies.back());
  }

  void write_mesh(ReplacedFile& out, const GlbMesh& m) {
    const std::size_t stride = m.stride();
    std::vector<char> rows;
    std::vector<std::uint32_t> indices;
    std::size_t vertices = 0;
    const auto each_patch = [&](const auto& work) {
      for (const auto c : m.copies) {
        for (const auto& placed : mesh_.patches().of_copy(c)) work(placed);
        if (m.shared) return;  // the others have the same
      }
    };
    // values are read in batches of patches; where the mesh is shared, those of its first copy stand for all
    std::vector<PlacedPatch> batch;
    std::size_t in_batch = 0;
    const auto flush = [&] {
      if (batch.empty()) return;
      progress_.check();
      const std::size_t first = batch.front().first_facet;
      const std::size_t count = batch.back().first_facet + batch.back().facets() - first;
      const auto shades = colours_.shades(first, count);
      const auto area = result_.rows<float>("facets/area", first, count);
      for (const auto& placed : batch) {
        const auto lit = colours_of(placed, shades, area, placed.first_facet - first);
        const Affine map =
            m.shared ? patch_to_plant(placed, geometry().copies[placed.copy].map) : Affine{placed.map.linear, placed.map.translation};
        for (std::size_t v = 0; v < placed.patch->vertices.size(); ++v) {
          const Vec3 p = map.point(placed.patch->vertices[v]) - (m.shared ? Vec3{0.0} : centre_);
          const glm::vec3 position(p);
          const Rgb linear = decode_srgb(lit.colours[v]);
          std::array<std::uint16_t, 4> colour{0, 0, 0, 65535};
          for (int k = 0; k < 3; ++k) colour[static_cast<std::size_t>(k)] = static_cast<std::uint16_t>(std::lround(65535.0f * linear[k]));
          const std::size_t at = rows.size();
          rows.resize(at + stride);
          std::memcpy(&rows[at], &position, 12);
          std::memcpy(&rows[at + 12], colour.data(), 8);
          if (!m.shared) std::memcpy(&rows[at + 20], &lit.values[v], 4);
        }
      }
      out.write(rows.data(), rows.size());
      rows.clear(), batch.clear();
      in_batch = 0;
      done_ += count;
      progress_.fraction("export", 0.4 + 0.6 * static_cast<double>(done_) / static_cast<double>(mesh_.facet_count()));
    };
    each_patch([&](const PlacedPatch& placed) {
      batch.push_back(placed);
      if ((in_batch += placed.facets()) >= 65536) flush();
    });
    flush();
    each_patch([&](const PlacedPatch& placed) {
      const bool mirrors = m.shared ? patch_to_plant(placed, geometry().copies[placed.copy].map).mirrors() : placed.mirrors;
      for (auto t : placed.patch->triangles) {
        if (mirrors) std::swap(t[1], t[2]);
        for (const auto v : t) indices.push_back(static_cast<std::uint32_t>(vertices + v));
      }
      vertices += placed.patch->vertices.size();
      if (indices.size() > 65536) out.write(indices.data(), indices.size() * 4), indices.clear();
    });
    out.write(indices.data(), indices.size() * 4);
    if (m.shared) write_places(out, m);
  }

  void write_places(ReplacedFile& out, const GlbMesh& m) const {
    const auto each = [&](const auto& work) {
      for (const auto c : m.copies) work(geometry().copies[c].map, *instance_of(geometry().copies[c].map));
    };
    each([&](const Affine& map, const Instance&) {
      const glm::vec3 t(map.translation - centre_);
      out.write(&t, 12);
    });
    each([&](const Affine&, const Instance& i) {
      const std::array<float, 4> q{static_cast<float>(i.turn.x), static_cast<float>(i.turn.y), static_cast<float>(i.turn.z),
                                   static_cast<float>(i.turn.w)};
      out.write(q.data(), 16);
    });
    each([&](const Affine&, const Instance& i) {
      const auto s = static_cast<float>(i.scale);
      const std::array<float, 3> scale{i.mirror ? -s : s, s, s};
      out.write(scale.data(), 12);
    });
  }

  const Result& result_;
  const MeshChoice& choice_;
  Progress& progress_;
  LitMesh mesh_;
  LitColours colours_;
  std::vector<std::string> placements_;
  std::vector<GlbMesh> meshes_;
  Vec3 centre_{0.0};
  std::size_t done_ = 0;
};

}  // namespace

void export_glb(const Result& result, const std::string& file, const MeshChoice& choice, Progress& progress) {
  GlbWriter(result, choice, progress).write(file);
}

}  // namespace sunfleck
