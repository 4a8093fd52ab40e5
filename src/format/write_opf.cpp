#include <sunfleck/format/write_opf.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <format/xml_text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/replaced_file.hpp>

namespace sunfleck {

namespace {

constexpr double cm = 100.0;

class FileWriter final : public pugi::xml_writer {
 public:
  explicit FileWriter(ReplacedFile& file) : file_(file) {}
  void write(const void* data, std::size_t size) override { file_.write(data, size); }

 private:
  ReplacedFile& file_;
};

void save(const pugi::xml_document& document, const std::string& path) {
  ReplacedFile out(path);
  FileWriter writer(out);
  document.save(writer, "\t", pugi::format_indent, pugi::encoding_utf8);
  out.commit();
}

bool is_link(const std::string& name) {
  return name == "decomp" || name == "branch" || name == "follow";
}

void put_text(pugi::xml_node parent, const std::string& name, const std::string& text) {
  parent.append_child(name.c_str()).append_child(pugi::node_pcdata).set_value(text.c_str());
}

void add_columns(pugi::xml_node node, const StructureColumns& columns, std::size_t structure) {
  for (std::size_t c = 0; c < columns.names.size(); ++c) {
    const double value = columns.values[c][structure];
    while (auto old = node.child(columns.names[c].c_str())) node.remove_child(old);
    if (std::isnan(value)) continue;
    // before what hangs on this structure, as AMAP programs write it
    pugi::xml_node first;
    for (const auto child : node.children())
      if (is_link(child.name()) || std::string_view(child.name()) == "geometry") {
        first = child;
        break;
      }
    auto added = first ? node.insert_child_before(columns.names[c].c_str(), first) : node.append_child(columns.names[c].c_str());
    added.append_child(pugi::node_pcdata).set_value(fmt::format("{}", value).c_str());
  }
}

void declare(pugi::xml_node list, const std::string& name, const char* type) {
  auto attribute = list.append_child("attribute");
  attribute.append_attribute("name") = name.c_str();
  attribute.append_attribute("class") = type;
}

/// Elements below a structure that are no attributes.
bool is_reserved(const std::string& name) {
  return is_link(name) || name == "geometry";
}

/// A name that XML takes: attributes of other formats may have blanks.
std::string element_name(const std::string& text) {
  std::string name;
  for (const char c : text) name += std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-' ? c : '_';
  const bool first = !name.empty() && (std::isalpha(static_cast<unsigned char>(name[0])) || name[0] == '_');
  return !first || is_reserved(name) ? "_" + name : name;
}

std::string value_text(const AttributeValue& value) {
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

const char* class_of(const AttributeValue& value) {
  static constexpr const char* names[] = {"Boolean", "Integer", "Double", "String"};
  return names[value.index()];
}

class OpfWriter {
 public:
  OpfWriter(const Plant& plant, const StructureColumns& columns)
      : plant_(plant),
        columns_(columns),
        attribute_names_(distinct_names(plant.attribute_names, element_name, {columns.names.begin(), columns.names.end()})) {
    auto root = document_.append_child("opf");
    root.append_attribute("version") = "2.0";
    root.append_attribute("editable") = "true";
    meshes_ = root.append_child("meshBDD");
    auto materials = root.append_child("materialBDD");
    shapes_ = root.append_child("shapeBDD");
    add_materials(materials);
    add_attributes(root.append_child("attributeBDD"));
    add_topology(root.append_child("topology"));
  }

  void write(const std::string& file) const { save(document_, file); }

 private:
  static bool kept_elsewhere(const std::string& name) { return name == "scale" || name == "id" || name == "link"; }

  void add_materials(pugi::xml_node list) const {
    for (std::size_t m = 0; m < std::max<std::size_t>(plant_.materials.size(), 1); ++m) {
      auto material = list.append_child("material");
      material.append_attribute("Id") = static_cast<unsigned long long>(m);
      if (m < plant_.materials.size() && !plant_.materials[m].empty()) material.append_attribute("name") = plant_.materials[m].c_str();
      put_text(material, "emission", "0.0 0.0 0.0 0.0");
      put_text(material, "ambient", "0.1 0.4 0.1 1.0");
      put_text(material, "diffuse", "0.2 0.55 0.15 1.0");
      put_text(material, "specular", "0.0 0.0 0.0 1.0");
      put_text(material, "shininess", "10.0");
    }
  }

  void add_attributes(pugi::xml_node list) const {
    std::vector<const char*> classes(plant_.attribute_names.size(), nullptr);
    for (const auto& structure : plant_.structures)
      for (const auto& [name, value] : structure.attributes) {
        const char* type = class_of(value);
        auto& known = classes[name];
        if (!known)
          known = type;
        else if (std::string_view(known) != type)  // whole numbers among numbers are numbers; anything else is text
          known = (std::string_view(known) == "Double" && std::string_view(type) == "Integer") ||
                          (std::string_view(known) == "Integer" && std::string_view(type) == "Double")
                      ? "Double"
                      : "String";
      }
    for (std::size_t a = 0; a < classes.size(); ++a)
      if (classes[a] && !kept_elsewhere(plant_.attribute_names[a])) declare(list, attribute_names_[a], classes[a]);
    if (std::find(plant_.attribute_names.begin(), plant_.attribute_names.end(), "Name") == plant_.attribute_names.end())
      declare(list, "Name", "String");
    for (const auto& name : columns_.names) declare(list, name, "Double");
  }

  void add_topology(pugi::xml_node root) {
    std::vector<std::vector<const Shape*>> shapes_of(plant_.structures.size());
    for (const auto& shape : plant_.shapes) shapes_of[shape.structure].push_back(&shape);
    std::vector<pugi::xml_node> nodes;
    std::vector<std::size_t> depth;
    for (std::uint32_t s = 0; s < plant_.structures.size(); ++s) {
      const auto& structure = plant_.structures[s];
      const bool top = structure.parent == no_parent;
      const auto* link = plant_.attribute(s, "link");
      const auto* name = link ? std::get_if<std::string>(link) : nullptr;
      if (top && s > 0) throw InputError(plant_.file, "two structures without a parent", "one, the plant");
      auto node = top ? root : nodes[structure.parent].append_child(name && is_link(*name) ? name->c_str() : "decomp");
      nodes.push_back(node);
      depth.push_back(top ? 1 : depth[structure.parent] + 1);
      node.append_attribute("class") = plant_.types[structure.type].c_str();
      const auto own = [&](const char* key, std::int64_t otherwise) {
        const auto* value = plant_.attribute(s, key);
        const auto* whole = value ? std::get_if<std::int64_t>(value) : nullptr;
        node.append_attribute(key) = static_cast<long long>(whole ? *whole : otherwise);
      };
      own("scale", static_cast<std::int64_t>(depth.back())), own("id", s + 1);
      for (const auto& [key, value] : structure.attributes)
        if (!kept_elsewhere(plant_.attribute_names[key])) put_text(node, attribute_names_[key], value_text(value));
      const std::string unnamed = plant_.types[structure.type] + "_" + node.attribute("id").value();  // what readers call it then
      if (!structure.name.empty() && structure.name != unnamed && !plant_.attribute(s, "Name")) put_text(node, "Name", structure.name);
      add_columns(node, columns_, s);
      if (!shapes_of[s].empty()) add_geometry(node, shapes_of[s]);
    }
  }

  void add_geometry(pugi::xml_node node, const std::vector<const Shape*>& shapes) {
    const bool single = shapes.size() == 1;
    const std::int64_t id = single ? shared(*shapes[0]) : merged(shapes);
    const Affine map = single ? shapes[0]->placement : Affine{};
    auto geometry = node.append_child("geometry");
    geometry.append_attribute("class") = "Mesh";
    put_text(geometry, "shapeIndex", std::to_string(id));
    std::string mat = "\n";
    for (int row = 0; row < 3; ++row)
      mat += fmt::format("{}\t{}\t{}\t{}\n", cm * map.linear[0][row], cm * map.linear[1][row], cm * map.linear[2][row],
                         cm * map.translation[row]);
    put_text(geometry, "mat", mat);
    put_text(geometry, "dUp", "1.0");
    put_text(geometry, "dDwn", "1.0");
  }

  std::int64_t shared(const Shape& shape) {
    const auto [at, added] = shape_ids_.try_emplace({shape.mesh, shape.first_triangle, shape.triangle_count, shape.material}, next_shape_);
    if (!added) return at->second;
    std::vector<Triangle> corners;
    const Mesh& mesh = plant_.meshes[shape.mesh];
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) corners.push_back(mesh.corners(shape.first_triangle + t));
    return add_mesh_and_shape(corners, shape.material);
  }

  std::int64_t merged(const std::vector<const Shape*>& shapes) {
    std::vector<Triangle> corners;
    for (const auto* shape : shapes)
      for (std::uint32_t t = 0; t < shape->triangle_count; ++t) corners.push_back(shape_triangle(plant_, *shape, t));
    return add_mesh_and_shape(corners, shapes[0]->material);
  }

  std::int64_t add_mesh_and_shape(const std::vector<Triangle>& corners, std::uint32_t material) {
    const std::int64_t id = next_shape_++;
    auto mesh = meshes_.append_child("mesh");
    mesh.append_attribute("name") = "";
    mesh.append_attribute("shape") = "";
    mesh.append_attribute("Id") = static_cast<long long>(id);
    mesh.append_attribute("enableScale") = "false";
    std::map<std::tuple<double, double, double>, std::size_t> rows;
    std::vector<Vec3> points, normals;
    std::string points_text = "\n", normals_text = "\n";
    std::vector<std::array<std::size_t, 3>> faces;
    for (const auto& triangle : corners) {
      auto& face = faces.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = triangle[c];
        const auto [at, added] = rows.try_emplace({p.x, p.y, p.z}, points.size());
        if (added) points.push_back(p), normals.emplace_back(0.0);
        face[c] = at->second;
        normals[at->second] += area_vector(triangle);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double length = glm::length(normals[i]);
      const Vec3 n = length > 0 ? normals[i] / length : Vec3{0, 0, 1};
      points_text += fmt::format("{}\t{}\t{}\t", points[i].x, points[i].y, points[i].z);
      normals_text += fmt::format("{}\t{}\t{}\t", static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z));
    }
    put_text(mesh, "points", points_text + "\n");
    put_text(mesh, "normals", normals_text + "\n");
    auto list = mesh.append_child("faces");
    for (std::size_t f = 0; f < faces.size(); ++f) {
      auto face = list.append_child("face");
      face.append_attribute("Id") = static_cast<unsigned long long>(f);
      face.append_child(pugi::node_pcdata).set_value(fmt::format("\n{}\t{}\t{}\n", faces[f][0], faces[f][1], faces[f][2]).c_str());
    }
    auto shape = shapes_.append_child("shape");
    shape.append_attribute("Id") = static_cast<long long>(id);
    put_text(shape, "name", fmt::format("Mesh{}", id));
    put_text(shape, "meshIndex", std::to_string(id));
    put_text(shape, "materialIndex", std::to_string(material));
    return id;
  }

  const Plant& plant_;
  const StructureColumns& columns_;
  std::vector<std::string> attribute_names_;  ///< as elements
  pugi::xml_document document_;
  pugi::xml_node meshes_, shapes_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>, std::int64_t> shape_ids_;
  std::int64_t next_shape_ = 0;
};

}  // namespace

void write_opf(const Plant& plant, const StructureColumns& columns, const std::string& file) {
  OpfWriter(plant, columns).write(file);
}

void add_to_opf(const std::string& original, const StructureColumns& columns, std::size_t structures, const std::string& file) {
  std::vector<std::string> known;  // those of the plant, which were told when it was read
  const std::string text = read_xml(original, known);
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size(), pugi::parse_full, pugi::encoding_utf8);
  if (!parsed) throw InputError(original, fmt::format("broken XML ({})", parsed.description()), "well-formed XML");
  for (auto node : document.children())
    if (node.type() == pugi::node_declaration && node.attribute("encoding")) node.attribute("encoding") = "UTF-8";
  const auto root = document.document_element();
  const auto topology = root.child("topology");
  if (!topology) throw InputError(original, "no <topology>", "the plant's structures");

  std::vector<pugi::xml_node> open{topology}, nodes;
  while (!open.empty()) {  // depth first, as read_opf numbers them
    const auto node = open.back();
    open.pop_back();
    nodes.push_back(node);
    std::vector<pugi::xml_node> children;
    for (const auto child : node.children())
      if (is_link(child.name())) children.push_back(child);
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  if (nodes.size() != structures)
    throw InputError(location(original, 0, "topology"), fmt::format("{} structures", nodes.size()),
                     fmt::format("the {} of the plant that was solved", structures));
  auto list = root.child("attributeBDD");
  if (!list) list = document.document_element().insert_child_before("attributeBDD", topology);
  std::set<std::string> declared;
  for (const auto attribute : list.children("attribute")) declared.insert(attribute.attribute("name").value());
  for (const auto& name : columns.names)
    if (!declared.contains(name)) declare(list, name, "Double");
  for (std::size_t s = 0; s < nodes.size(); ++s) add_columns(nodes[s], columns, s);
  save(document, file);
}

}  // namespace sunfleck
