// PLY (Turk 1994): ascii and both binary orders, properties in any order and of any type, coordinates in double precision.
#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <format/organs.hpp>
#include <format/polygons.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/plant/build.hpp>

namespace sunfleck {

namespace {

enum class Number { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Encoding { ascii, little, big };

constexpr std::array<std::size_t, 8> bytes_of = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
  std::string name;
  Number type = Number::f64;
  bool is_list = false;
  Number count_type = Number::u8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// Bytes of one element whose lists are empty (ascii: a digit and a blank for each value).
  std::uint64_t least_bytes(Encoding encoding) const {
    std::uint64_t sum = 0;
    for (const auto& p : properties) sum += encoding == Encoding::ascii ? 2 : bytes_of[static_cast<int>(p.is_list ? p.count_type : p.type)];
    return sum;
  }
  int find(const char* property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == property) return static_cast<int>(i);
    return -1;
  }
};

bool number_type(std::string_view word, Number& type) {
  static constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                            {"uchar", "uint8"},
                                                                            {"short", "int16"},
                                                                            {"ushort", "uint16"},
                                                                            {"int", "int32"},
                                                                            {"uint", "uint32"},
                                                                            {"float", "float32"},
                                                                            {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (word == names[i][0] || word == names[i][1]) {
      type = static_cast<Number>(i);
      return true;
    }
  return false;
}

template <class T>
double decoded(const char* from, bool swap) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), from, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

class PlyReader {
 public:
  explicit PlyReader(const std::string& file) : file_(file), bytes_(without_mark(read_whole(file), file)), lines_(bytes_) {}

  Plant read() {
    read_header();
    bool has_vertices = false, has_faces = false;
    for (const auto& element : elements_) {
      has_vertices |= element.name == "vertex";
      has_faces |= element.name == "face";
      if (element.name == "vertex") vertex_count_ = element.count;
    }
    if (!has_vertices) throw InputError(file_, "no element vertex", "vertices with x, y and z");
    if (!has_faces) throw InputError(file_, "no element face", "faces with vertex_indices");
    for (const auto& element : elements_) read_element(element);
    build();
    return std::move(plant_);
  }

 private:
  std::string here() const {
    return encoding_ == Encoding::ascii || in_header_ ? location(file_, lines_.number())
                                                      : location(file_, 0, fmt::format("byte {}", start_));
  }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const { throw InputError(here(), found, expected); }

  // ---- header

  void read_header() {
    std::string_view line;
    if (!lines_.next(line) || line != "ply") throw InputError(location(file_, 1), in_quotes(line), "\"ply\"");
    bool has_format = false;
    while (true) {
      if (!lines_.next(line)) fail("the end of the file in the header", "end_header");
      Words words(line);
      const std::string_view key = words.next();
      if (key == "end_header") break;
      if (key == "format")
        read_format(words.next()), has_format = true;
      else if (key == "element")
        read_element_line(words);
      else if (key == "property")
        read_property_line(words);
      else if (!key.empty() && key != "comment" && key != "obj_info")
        fail(fmt::format("header line {}", in_quotes(line)), "format, element, property, comment or end_header");
    }
    if (!has_format) fail("no format", "ascii, binary_little_endian or binary_big_endian");
    in_header_ = false;
    at_ = start_ = lines_.offset();
    swap_ = (encoding_ == Encoding::big) != (std::endian::native == std::endian::big);
  }

  void read_format(std::string_view word) {
    if (word == "ascii")
      encoding_ = Encoding::ascii;
    else if (word == "binary_little_endian")
      encoding_ = Encoding::little;
    else if (word == "binary_big_endian")
      encoding_ = Encoding::big;
    else
      fail(fmt::format("format {}", in_quotes(word)), "ascii, binary_little_endian or binary_big_endian");
  }

  void read_element_line(Words& words) {
    Element element;
    element.name = words.next();
    const std::string_view count = words.next();
    std::int64_t n = 0;
    if (element.name.empty() || !to_integer(count, n) || n < 0)
      fail(fmt::format("element {} {}", in_quotes(element.name), in_quotes(count)), "a name and a count");
    for (const auto& other : elements_)
      if (other.name == element.name) fail(fmt::format("a second element {}", in_quotes(element.name)), "every element once");
    element.count = static_cast<std::uint64_t>(n);
    elements_.push_back(std::move(element));
  }

  void read_property_line(Words& words) {
    if (elements_.empty()) fail("a property before any element", "an element line first");
    Property property;
    std::string_view type = words.next();
    if (type == "list") {
      property.is_list = true;
      const std::string_view count = words.next();
      if (!number_type(count, property.count_type) || property.count_type == Number::f32 || property.count_type == Number::f64)
        fail(fmt::format("list count type {}", in_quotes(count)), "an integer type such as uchar");
      type = words.next();
    }
    if (!number_type(type, property.type))
      fail(fmt::format("property type {}", in_quotes(type)), "char, uchar, short, ushort, int, uint, float or double");
    property.name = words.next();
    if (property.name.empty()) fail("a property without a name", "property TYPE NAME");
    elements_.back().properties.push_back(std::move(property));
  }

  // ---- values

  double next_value(Number type, const Property& property) {
    if (encoding_ == Encoding::ascii) {
      const std::string_view word = words_.next();
      double value = 0;
      if (word.empty()) fail(fmt::format("the end of the line before {}", in_quotes(property.name)), "a number");
      if (!to_number(word, value)) fail(fmt::format("{} for {}", in_quotes(word), in_quotes(property.name)), "a number");
      return value;
    }
    const std::size_t size = bytes_of[static_cast<int>(type)];
    if (bytes_.size() - at_ < size)
      fail(fmt::format("the end of the file in {}", in_quotes(property.name)), fmt::format("{} more bytes", size));
    const char* from = bytes_.data() + at_;
    at_ += size;
    switch (type) {
      case Number::i8:
        return decoded<std::int8_t>(from, swap_);
      case Number::u8:
        return decoded<std::uint8_t>(from, swap_);
      case Number::i16:
        return decoded<std::int16_t>(from, swap_);
      case Number::u16:
        return decoded<std::uint16_t>(from, swap_);
      case Number::i32:
        return decoded<std::int32_t>(from, swap_);
      case Number::u32:
        return decoded<std::uint32_t>(from, swap_);
      case Number::f32:
        return decoded<float>(from, swap_);
      case Number::f64:
        break;
    }
    return decoded<double>(from, swap_);
  }

  std::uint64_t next_count(const Property& property) {
    const double n = next_value(property.count_type, property);
    const std::uint64_t left = (bytes_.size() - (encoding_ == Encoding::ascii ? 0 : at_)) /
                               (encoding_ == Encoding::ascii ? 1 : bytes_of[static_cast<int>(property.type)]);
    if (!(n >= 0) || n != std::floor(n) || n > static_cast<double>(left))
      fail(fmt::format("{} values in list {}", n, in_quotes(property.name)), fmt::format("0 to {}", left));
    return static_cast<std::uint64_t>(n);
  }

  /// The values of one element: scalars by property; the list named `list` goes into list_.
  void next_values(const Element& element, int list) {
    if (encoding_ == Encoding::ascii) {
      std::string_view line;
      do
        if (!lines_.next(line))
          fail(fmt::format("the end of the file in element {}", in_quotes(element.name)), fmt::format("{} of them", element.count));
      while (line.find_first_not_of(" \t\r") == std::string_view::npos);
      words_ = Words(line);
    }
    start_ = at_;
    scalars_.resize(element.properties.size());
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      if (!property.is_list) {
        scalars_[p] = next_value(property.type, property);
        continue;
      }
      const std::uint64_t n = next_count(property);
      const bool wanted = static_cast<int>(p) == list;
      if (wanted) list_.clear();
      for (std::uint64_t i = 0; i < n; ++i) {
        const double value = next_value(property.type, property);
        if (wanted) list_.push_back(value);
      }
    }
    if (encoding_ == Encoding::ascii)
      if (const auto extra = words_.next(); !extra.empty())
        fail(fmt::format("{} after the last value", in_quotes(extra)), "the end of the line");
  }

  // ---- elements

  void read_element(const Element& element) {
    const std::uint64_t left = bytes_.size() - (encoding_ == Encoding::ascii ? lines_.offset() : at_);
    const std::uint64_t least = element.least_bytes(encoding_);
    start_ = at_;
    if (least > 0 && element.count > (left + 1) / least)  // + 1: the last line may have no end
      fail(fmt::format("{} times element {} in the header", element.count, in_quotes(element.name)),
           fmt::format("no more than fit into the {} bytes that follow", left));
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    if (least == 0) return;
    for (std::uint64_t i = 0; i < element.count; ++i) next_values(element, -1);
  }

  void read_vertices(const Element& element) {
    std::array<int, 3> xyz{};
    for (int axis = 0; axis < 3; ++axis) {
      constexpr std::array<const char*, 3> names = {"x", "y", "z"};
      xyz[axis] = element.find(names[axis]);
      if (xyz[axis] < 0 || element.properties[xyz[axis]].is_list)
        throw InputError(file_, fmt::format("no vertex property {}", names[axis]), "x, y and z");
    }
    if (element.count > 0xfffffffeu) fail(fmt::format("{} vertices", element.count), "fewer than 4,294,967,295");
    mesh_.vertices.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      next_values(element, -1);
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        p[axis] = scalars_[xyz[axis]];
        if (!std::isfinite(p[axis])) fail(fmt::format("{} = {} in vertex {}", "xyz"[axis], p[axis], i), "a finite number");
      }
      mesh_.vertices.push_back(p);
    }
  }

  void read_faces(const Element& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || !element.properties[list].is_list)
      throw InputError(file_, "no face list vertex_indices", "property list uchar int vertex_indices");
    const int organ = element.find("organ");
    if (organ >= 0 && element.properties[organ].is_list) throw InputError(file_, "face property organ as a list", "property int organ");
    has_organs_ = organ >= 0;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      next_values(element, list);
      if (list_.size() < 3) fail(fmt::format("face {} with {} corners", i, list_.size()), "at least three");
      for (const double index : list_)
        if (!(index >= 0) || index >= static_cast<double>(vertex_count_) || index != std::floor(index))
          fail(fmt::format("vertex index {} in face {}", index, i), fmt::format("0 to {}", static_cast<std::int64_t>(vertex_count_) - 1));
      std::uint32_t owner = 0;
      if (has_organs_) owner = organ_number(scalars_[organ], i);
      corners_.assign(list_.begin(), list_.end());
      if (mesh_.vertices.size() == vertex_count_) {
        for (const auto& t : cutter_.cut(mesh_.vertices, corners_, file_, line_of_face())) mesh_.triangles.push_back(t);
      } else {  // faces before vertices: cut where these are known
        late_.push_back({line_of_face(), mesh_.triangles.size(), corners_});
        mesh_.triangles.resize(mesh_.triangles.size() + corners_.size() - 2);
      }
      owner_.resize(mesh_.triangles.size(), owner);
    }
  }

  long line_of_face() const { return encoding_ == Encoding::ascii ? lines_.number() : 0; }

  std::uint32_t organ_number(double value, std::uint64_t face) {
    if (value != std::floor(value) || !(std::abs(value) < 9e15)) fail(fmt::format("organ {} of face {}", value, face), "a whole number");
    const auto [at, fresh] = organ_index_.try_emplace(static_cast<std::int64_t>(value), static_cast<std::uint32_t>(organ_names_.size()));
    if (fresh) organ_names_.push_back(std::to_string(static_cast<std::int64_t>(value)));
    return at->second;
  }

  void build() {
    for (const auto& face : late_) {
      const auto& triangles = cutter_.cut(mesh_.vertices, face.corners, file_, face.line);
      std::copy(triangles.begin(), triangles.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(face.first_triangle));
    }
    cutter_.note(file_, plant_.notes);
    if (!has_organs_) {
      owner_ = connected_components(mesh_);
      const std::uint32_t count = owner_.empty() ? 0 : *std::max_element(owner_.begin(), owner_.end()) + 1;
      for (std::uint32_t c = 0; c < count; ++c) organ_names_.push_back(std::to_string(c + 1));
    }
    std::vector<std::uint32_t> structure;
    for (const auto& name : organ_names_) structure.push_back(add_structure(plant_, 0, "organ", name));
    for (auto& organ : owner_) organ = structure[organ];
    const std::uint32_t material = plant_.material_index("");
    add_mesh(plant_, std::move(mesh_), owner_, std::vector(owner_.size(), material));
    check_plant(plant_);
  }

  const std::string& file_;
  std::string bytes_;
  Lines lines_;
  Words words_{std::string_view{}};
  Encoding encoding_ = Encoding::ascii;
  bool in_header_ = true, swap_ = false, has_organs_ = false;
  std::size_t at_ = 0, start_ = 0;  ///< in a binary body: the next byte, and where the element being read starts
  std::vector<Element> elements_;
  std::uint64_t vertex_count_ = 0;
  std::vector<double> scalars_, list_;
  Plant plant_ = empty_plant(clean_name(std::filesystem::path(file_).stem().string()), file_);
  Mesh mesh_;
  PolygonCutter cutter_;
  std::vector<LateFace> late_;
  std::vector<std::uint32_t> owner_, corners_;
  std::vector<std::string> organ_names_;
  std::unordered_map<std::int64_t, std::uint32_t> organ_index_;
};

}  // namespace

Plant read_ply(const std::string& file) {
  return PlyReader(file).read();
}

}  // namespace sunfleck
