// Open Plant Format (AMAP): XML with shared meshes, shapes, typed attributes and a topology. Checked against PlantGeom.jl (VEZY),
// read_opf.jl and tapering.jl: `mat` is a 3x4 row-major map from mesh to plant, absolute and not relative to the parent; a mesh with
// enableScale has its y and z multiplied by a factor that runs linearly along x from dDwn (smallest x) to dUp (largest x) before `mat`.
// PlantGeom.jl leaves a mesh as it is if only one of the two is 1; here that one tapers like any other.
#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <format/polygons.hpp>
#include <format/text.hpp>
#include <format/xml_text.hpp>
#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

enum class Kind { text, integer, number, boolean, unknown };

Kind kind_of_class(std::string_view name) {
  if (name == "Integer") return Kind::integer;
  if (name == "Boolean") return Kind::boolean;
  for (const auto number : {"Double", "Metre", "Centimetre", "Millimetre", "10E-5 Metre", "Metre_100"})
    if (name == number) return Kind::number;
  return Kind::text;
}

std::string_view trimmed(const char* text) {
  return Words(text).rest();
}

bool to_boolean(std::string_view word, bool& value) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  value = lower == "true";
  return value || lower == "false";
}

struct OpfMesh {
  std::uint32_t mesh = 0;  ///< index into Plant::meshes
  bool tapers = true;
};

struct OpfShape {
  OpfMesh mesh;
  std::uint32_t material = 0;
};

/// Words of a text of any number of lines.
template <class Call>
void for_each_word(const char* text, Call&& call) {
  std::string_view rest(text);
  while (true) {
    const std::size_t begin = rest.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return;
    rest.remove_prefix(begin);
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
    rest.remove_prefix(word.size());
    call(word);
  }
}

/// Rigid frame of a structure: local +z along the map's x axis, local +x along its y axis as far as it is orthogonal; mirrored if the map
/// is.
Mat3 axis_frame(const Mat3& map) {
  const auto direction = [](const Vec3& v, const Vec3& otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
  };
  const Vec3 z = direction(map[0], {0, 0, 1});
  const Vec3 least = std::abs(z.x) <= std::abs(z.y) && std::abs(z.x) <= std::abs(z.z) ? Vec3{1, 0, 0}
                     : std::abs(z.y) <= std::abs(z.z)                                 ? Vec3{0, 1, 0}
                                                                                      : Vec3{0, 0, 1};
  const Vec3 any = glm::normalize(least - glm::dot(least, z) * z);
  const Vec3 unit_y = direction(map[1], any);
  const Vec3 across = unit_y - glm::dot(unit_y, z) * z;
  const Vec3 x = glm::length(across) > 1e-9 ? glm::normalize(across) : any;
  const Vec3 y = glm::cross(z, x);
  return {x, glm::determinant(map) < 0 ? -y : y, z};
}

/// What programs write where a structure has no such value: R, Julia, Python, JSON and spreadsheets.
bool says_nothing(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto nothing : {"", "na", "nan", "missing", "null", "none", "nothing", "undefined", "n/a", "-"})
    if (lower == nothing) return true;
  return false;
}

/// A value as its class has it; "3.0" is a whole number too. Nothing where it is none.
std::optional<AttributeValue> value_of(std::string_view word, Kind kind) {
  bool truth = false;
  double number = 0;
  std::int64_t whole = 0;
  if ((kind == Kind::boolean || kind == Kind::unknown) && to_boolean(word, truth)) return truth;
  if (kind == Kind::boolean && (word == "0" || word == "1")) return word == "1";
  if ((kind == Kind::integer || kind == Kind::unknown) && to_integer(word, whole)) return whole;
  if (kind != Kind::boolean && kind != Kind::text && to_number(word, number)) {
    if (kind == Kind::integer && std::abs(number) < 9e18 && number == std::floor(number)) return static_cast<std::int64_t>(number);
    if (kind != Kind::integer && std::isfinite(number)) return number;
    return std::nullopt;
  }
  if (kind == Kind::text || kind == Kind::unknown) return std::string(word);
  return std::nullopt;
}

/// Values of one attribute that its class does not allow.
struct LeftOut {
  std::size_t count = 0;
  std::string example;
  long line = 0;

  std::string note(const std::string& file, const std::string& attribute, Kind kind) const {
    const char* expected = kind == Kind::boolean ? "true or false" : kind == Kind::integer ? "a whole number" : "a finite number";
    return fmt::format("{}: {} is not {}{}: left out{}", location(file, line, attribute), example, expected,
                       kind == Kind::unknown ? "" : ", as the class of the attribute says",
                       count > 1 ? fmt::format(", as are {} more of this attribute", count - 1) : "");
  }
};

class OpfReader {
 public:
  explicit OpfReader(const std::string& file) : file_(file) {}

  Plant read() {
    std::string text = read_xml(file_, plant_.notes);
    bytes_ = text.size();
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) line_ends_.push_back(at);
    pugi::xml_document document;
    const auto result = document.load_buffer_inplace(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
      throw InputError(location(file_, line_at(result.offset)), fmt::format("broken XML ({})", result.description()), "well-formed XML");
    const auto root = document.document_element();
    if (std::string_view(root.name()) != "opf") fail(root, fmt::format("root element <{}>", root.name()), "<opf>");
    read_meshes(root.child("meshBDD"));
    read_materials(root.child("materialBDD"));
    read_shapes(root.child("shapeBDD"));
    for (const auto node : root.child("attributeBDD").children("attribute"))
      kinds_[node.attribute("name").value()] = kind_of_class(node.attribute("class").value());
    const auto topology = root.child("topology");
    if (!topology) fail(root, "no <topology>", "the plant's structures");
    read_topology(topology);
    plant_.name = plant_.structures[0].name;
    drop_unused_meshes();
    cutter_.note(file_, plant_.notes);
    for (const auto& [what, left_out] : left_out_) plant_.notes.push_back(left_out.note(file_, what.first, what.second));
    check_plant(plant_);
    return std::move(plant_);
  }

 private:
  long line_at(std::ptrdiff_t offset) const {
    if (offset < 0) return 0;
    return 1 + (std::lower_bound(line_ends_.begin(), line_ends_.end(), static_cast<std::size_t>(offset)) - line_ends_.begin());
  }

  [[noreturn]] void fail(pugi::xml_node node, const std::string& found, const std::string& expected) const {
    throw InputError(location(file_, line_at(node.offset_debug()), node.name()), found, expected);
  }

  std::int64_t integer(pugi::xml_node node, std::string_view word) const {
    std::int64_t value = 0;
    if (!to_integer(word, value)) fail(node, word.empty() ? "nothing" : in_quotes(word), "a whole number");
    return value;
  }

  std::int64_t id_of(pugi::xml_node node, const char* key) const {
    const auto attribute = node.attribute(key);
    if (!attribute) fail(node, fmt::format("no {}", key), fmt::format("{}=\"number\"", key));
    return integer(node, trimmed(attribute.value()));
  }

  std::vector<double> numbers(pugi::xml_node node) const {
    std::vector<double> values;
    for_each_word(node.child_value(), [&](std::string_view word) {
      double value = 0;
      if (!to_number(word, value) || !std::isfinite(value))
        fail(node, fmt::format("number {} = {}", values.size() + 1, in_quotes(word)), "a finite number");
      values.push_back(value);
    });
    return values;
  }

  /// A width that is not there, or "NaN" as AMAP programs write for none, leaves the mesh as it is.
  double width(pugi::xml_node geometry, const char* key) const {
    const auto node = geometry.child(key);
    if (!node) return 1.0;
    const std::string_view word = trimmed_text(node);
    if (!word.empty() && says_nothing(word)) return 1.0;
    double value = 0;
    if (!to_number(word, value) || std::isinf(value))
      fail(node, word.empty() ? "nothing" : in_quotes(word), "a finite number, or NaN for none");
    return value;
  }

  static std::string_view trimmed_text(pugi::xml_node node) {
    std::string_view text(node.child_value());
    const auto begin = text.find_first_not_of(" \t\r\n");
    return begin == std::string_view::npos ? std::string_view{} : text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
  }

  void read_meshes(pugi::xml_node list) {
    for (const auto node : list.children("mesh")) {
      Mesh mesh;
      const auto points = node.child("points");
      const auto xyz = numbers(points);
      if (xyz.size() % 3 != 0) fail(points, fmt::format("{} numbers", xyz.size()), "three for each point");
      for (std::size_t i = 0; i < xyz.size(); i += 3) mesh.vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
      read_faces(node, mesh);
      bool tapers = true;
      if (const auto flag = node.attribute("enableScale"); flag && !to_boolean(trimmed(flag.value()), tapers))
        fail(node, fmt::format("enableScale={}", in_quotes(flag.value())), "\"true\" or \"false\"");
      if (!meshes_.emplace(id_of(node, "Id"), OpfMesh{static_cast<std::uint32_t>(plant_.meshes.size()), tapers}).second)
        fail(node, fmt::format("a second mesh with Id {}", id_of(node, "Id")), "every Id once");
      plant_.meshes.push_back(std::move(mesh));
    }
  }

  void read_faces(pugi::xml_node mesh_node, Mesh& mesh) {
    const auto faces = mesh_node.child("faces");
    if (!faces) fail(mesh_node, "no <faces>", "a list of faces");
    std::vector<std::uint32_t> corners;
    const auto read_corners = [&](pugi::xml_node node) {
      corners.clear();
      for_each_word(node.child_value(), [&](std::string_view word) {
        const std::int64_t index = integer(node, word);
        if (index < 0 || index >= static_cast<std::int64_t>(mesh.vertices.size()))
          fail(node, fmt::format("point index {}", index),
               fmt::format("0 to {} (the mesh has {} points)", static_cast<std::int64_t>(mesh.vertices.size()) - 1, mesh.vertices.size()));
        corners.push_back(static_cast<std::uint32_t>(index));
      });
    };
    if (!faces.child("face")) {  // a flat list of triangles
      read_corners(faces);
      if (corners.size() % 3 != 0)
        fail(faces, fmt::format("{} point indices", corners.size()), "three for each triangle, or <face> elements");
      for (std::size_t i = 0; i < corners.size(); i += 3) mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
      return;
    }
    for (const auto face : faces.children("face")) {
      read_corners(face);
      if (corners.size() < 3) fail(face, fmt::format("a face with {} corners", corners.size()), "at least three");
      const long line = corners.size() > 3 ? line_at(face.offset_debug()) : 0;
      for (const auto& t : cutter_.cut(mesh.vertices, corners, file_, line)) mesh.triangles.push_back(t);
    }
  }

  void read_materials(pugi::xml_node list) {
    for (const auto node : list.children("material"))
      if (const auto name = node.attribute("name"); name && *name.value()) material_names_[id_of(node, "Id")] = name.value();
  }

  void read_shapes(pugi::xml_node list) {
    for (const auto node : list.children("shape")) {
      const auto mesh_node = node.child("meshIndex");
      if (!mesh_node) fail(node, "no <meshIndex>", "the Id of a mesh");
      const std::int64_t mesh_id = integer(mesh_node, trimmed_text(mesh_node));
      const auto mesh = meshes_.find(mesh_id);
      if (mesh == meshes_.end()) fail(mesh_node, fmt::format("mesh {}", mesh_id), "the Id of a mesh in meshBDD");
      std::string material;
      if (const auto material_node = node.child("materialIndex")) {
        const std::int64_t id = integer(material_node, trimmed_text(material_node));
        const auto named = material_names_.find(id);
        material = named == material_names_.end() ? fmt::format("material_{}", id) : named->second;
      }
      if (!shapes_.emplace(id_of(node, "Id"), OpfShape{mesh->second, material_index_(material)}).second)
        fail(node, fmt::format("a second shape with Id {}", id_of(node, "Id")), "every Id once");
    }
  }

  /// Depth first with a stack of our own: a plant may be a hundred thousand elements deep.
  void read_topology(pugi::xml_node topology) {
    std::vector<std::pair<pugi::xml_node, std::uint32_t>> open{{topology, no_parent}};
    std::vector<pugi::xml_node> children;
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      const auto class_name = node.attribute("class");
      if (!class_name || !*class_name.value()) fail(node, "no class", "class=\"name\"");
      const auto structure = static_cast<std::uint32_t>(plant_.structures.size());
      plant_.structures.emplace_back();
      plant_.structures[structure].parent = parent;
      plant_.structures[structure].type = type_index_(class_name.value());
      if (parent != no_parent) plant_.structures[structure].frame = plant_.structures[parent].frame;
      add_own_attributes(node, structure);
      children.clear();
      for (const auto child : node.children()) {
        if (child.type() != pugi::node_element) continue;
        const std::string_view name = child.name();
        if (name == "decomp" || name == "branch" || name == "follow")
          children.push_back(child);
        else if (name == "geometry")
          add_geometry(child, structure);
        else
          add_attribute(child, structure);
      }
      for (auto child = children.rbegin(); child != children.rend(); ++child) open.emplace_back(*child, structure);
    }
  }

  void add_own_attributes(pugi::xml_node node, std::uint32_t structure) {
    auto& attributes = plant_.structures[structure].attributes;
    std::string& name = plant_.structures[structure].name;
    name = node.attribute("class").value();
    for (const auto key : {"scale", "id"})
      if (const auto given = node.attribute(key)) {
        const auto value = value_of(trimmed(given.value()), Kind::integer);
        if (!value) {
          leave_out(node, key, Kind::integer, given.value());
          continue;
        }
        attributes.emplace_back(attribute_index_(key), *value);
        if (key[0] == 'i') name += fmt::format("_{}", std::get<std::int64_t>(*value));
      }
    if (plant_.structures[structure].parent != no_parent) attributes.emplace_back(attribute_index_("link"), std::string(node.name()));
  }

  /// An attribute that its class does not allow is left out with a note: light does not need it.
  void add_attribute(pugi::xml_node node, std::uint32_t structure) {
    const std::string_view word = trimmed_text(node);
    const std::string name = node.name();
    const auto listed = kinds_.find(name);
    const Kind kind = listed == kinds_.end() ? Kind::unknown : listed->second;
    if (word.empty() || (kind != Kind::text && (word == "NA" || word == "NaN"))) return;
    auto value = value_of(word, kind);
    if (!value) return leave_out(node, name, kind, word);
    if (name == "Name" && std::holds_alternative<std::string>(*value)) plant_.structures[structure].name = word;
    plant_.structures[structure].attributes.emplace_back(attribute_index_(name), std::move(*value));
  }

  void leave_out(pugi::xml_node node, const std::string& name, Kind kind, std::string_view word) {
    auto& left_out = left_out_[{name, kind}];
    if (left_out.count++ == 0) left_out.example = in_quotes(word), left_out.line = line_at(node.offset_debug());
  }

  void add_geometry(pugi::xml_node geometry, std::uint32_t structure) {
    Affine map;
    const auto mat = geometry.child("mat");
    if (mat) {
      const auto m = numbers(mat);
      if (m.size() != 12) fail(mat, fmt::format("{} numbers", m.size()), "12: three rows of four");
      map = {Mat3{Vec3{m[0], m[4], m[8]}, Vec3{m[1], m[5], m[9]}, Vec3{m[2], m[6], m[10]}}, Vec3{m[3], m[7], m[11]}};
      plant_.structures[structure].frame = {axis_frame(map.linear), map.translation};
    }
    const auto index = geometry.child("shapeIndex");
    if (!index) return;
    if (!mat) fail(geometry, "no <mat>", "12 numbers: three rows of four");
    const std::int64_t id = integer(index, trimmed_text(index));
    const auto found = shapes_.find(id);
    if (found == shapes_.end()) fail(index, fmt::format("shape {}", id), "the Id of a shape in shapeBDD");
    Shape shape;
    shape.structure = structure;
    shape.mesh = found->second.mesh.mesh;
    shape.material = found->second.material;
    shape.placement = map;
    if (found->second.mesh.tapers) {
      const double up = width(geometry, "dUp"), down = width(geometry, "dDwn");
      if (up == down) {  // an even width is a stretch
        shape.placement.linear[1] *= up;
        shape.placement.linear[2] *= up;
      } else {
        shape.mesh = tapered(shape.mesh, down, up);
      }
    }
    shape.triangle_count = static_cast<std::uint32_t>(plant_.meshes[shape.mesh].triangles.size());
    plant_.shapes.push_back(shape);
  }

  std::uint32_t tapered(std::uint32_t mesh, double down, double up) {
    const auto [at, fresh] = tapered_.try_emplace({mesh, down, up}, static_cast<std::uint32_t>(plant_.meshes.size()));
    if (!fresh) return at->second;
    // a few bytes of a file ask for a whole copy here; a real organ has as many bytes as its mesh has points, about
    tapered_points_ += plant_.meshes[mesh].vertices.size() + plant_.meshes[mesh].triangles.size();
    if (const std::size_t most = 1'000'000 + 16 * bytes_; tapered_points_ > most)
      throw InputError(location(file_), fmt::format("tapered copies of meshes with more than {} points and faces", most),
                       "fewer in a file of this size: organs of the same dUp and dDwn share one copy");
    Mesh copy = plant_.meshes[mesh];
    Box box;
    for (const auto& p : copy.vertices) box.add(p);
    const double length = box.size().x;
    for (auto& p : copy.vertices) {
      const double factor = length > 0 ? down + (up - down) * ((p.x - box.low.x) / length) : down;
      p.y *= factor;
      p.z *= factor;
    }
    plant_.meshes.push_back(std::move(copy));
    return at->second;
  }

  /// Meshes that only served as the stock of tapered ones are not kept.
  void drop_unused_meshes() {
    constexpr std::uint32_t unused = 0xffffffffu;
    std::vector<std::uint32_t> place(plant_.meshes.size(), unused);
    std::vector<Mesh> kept;
    for (auto& shape : plant_.shapes) {
      auto& to = place[shape.mesh];
      if (to == unused) {
        to = static_cast<std::uint32_t>(kept.size());
        kept.push_back(std::move(plant_.meshes[shape.mesh]));
      }
      shape.mesh = to;
    }
    plant_.meshes = std::move(kept);
  }

  const std::string& file_;
  std::vector<std::size_t> line_ends_;
  Plant plant_ = {.name = {},
                  .file = file_,
                  .types = {},
                  .attribute_names = {},
                  .materials = {},
                  .structures = {},
                  .meshes = {},
                  .shapes = {},
                  .notes = {}};
  NameIndex type_index_{plant_.types}, attribute_index_{plant_.attribute_names}, material_index_{plant_.materials};
  std::unordered_map<std::int64_t, OpfMesh> meshes_;
  std::unordered_map<std::int64_t, OpfShape> shapes_;
  std::unordered_map<std::int64_t, std::string> material_names_;
  std::unordered_map<std::string, Kind> kinds_;
  std::map<std::tuple<std::uint32_t, double, double>, std::uint32_t> tapered_;
  std::map<std::pair<std::string, Kind>, LeftOut> left_out_;
  PolygonCutter cutter_;
  std::size_t bytes_ = 0, tapered_points_ = 0;
};

}  // namespace

Plant read_opf(const std::string& file) {
  return OpfReader(file).read();
}

}  // namespace sunfleck
