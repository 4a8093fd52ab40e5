// Wavefront OBJ. Read here and not with tinyobjloader, which reads "nan" and broken numbers as 0, knows no line numbers and
// rounds coordinates in their last digits; materials are names only, so that no other file is opened.
#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <filesystem>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <format/organs.hpp>
#include <format/polygons.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/plant/build.hpp>

namespace sunfleck {

namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// A named part of the file: an object, or a group inside one.
struct Part {
  std::uint32_t object = none;  ///< index into the object names
  std::string name;
};

/// A line of numbers that ends with a backslash goes on in the next one; a comment or a name may end so by chance.
bool goes_on(std::string_view line) {
  Words words(line);
  const std::string_view key = words.next();
  return (key.starts_with('v') || key == "f" || key == "l" || key == "p") && line.find('#') == std::string_view::npos;
}

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : file_(file) {}

  Plant read() {
    const std::string text = read_text(file_, plant_.notes);
    Lines lines(text, goes_on);
    std::string_view line;
    while (lines.next(line)) {
      number_ = lines.number();
      Words words(line);
      const std::string_view key = words.next();
      if (key == "v")
        mesh_.vertices.push_back(read_point(words, file_, number_, "a vertex"));
      else if (key == "f")
        face(words);
      else if (key == "g")
        open_group(words.rest());
      else if (key == "o")
        open_object(words.rest());
      else if (key == "usemtl")
        material_ = material_index_(std::string(words.rest()));
      else if (key == "mtllib")
        outside_ += outside(words.rest());
      if (mesh_.vertices.size() >= none) fail("more than 4,294,967,294 vertices", "fewer");
    }
    for (const auto& [at, index] : ahead_)
      if (index >= static_cast<std::int64_t>(mesh_.vertices.size())) {
        number_ = at;
        out_of_range(index + 1);
      }
    for (const auto& face : late_) {
      const auto& triangles = cutter_.cut(mesh_.vertices, face.corners, file_, face.line);
      std::copy(triangles.begin(), triangles.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(face.first_triangle));
    }
    cutter_.note(file_, plant_.notes);
    if (outside_ > 0)
      plant_.notes.push_back(
          fmt::format("{}: mtllib names {} outside the folder of the OBJ: material libraries are not needed, and none is "
                      "opened",
                      file_, outside_ == 1 ? "a file" : fmt::format("{} files", outside_)));
    build();
    return std::move(plant_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(location(file_, number_), found, expected);
  }

  [[noreturn]] void out_of_range(std::int64_t index) const {
    fail(fmt::format("vertex index {}", index),
         fmt::format("1 to {} (vertices in the file), or counted back from -1", mesh_.vertices.size()));
  }

  std::uint32_t corner(std::string_view word) {
    std::int64_t index = 0;
    if (!to_integer(word.substr(0, word.find('/')), index))
      fail(fmt::format("face corner {}", in_quotes(word)), "a vertex index such as 7 or 7/1/2");
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (index == 0 || index < -count || index > static_cast<std::int64_t>(none)) out_of_range(index);
    if (index < 0) return static_cast<std::uint32_t>(count + index);
    if (index > count) ahead_.emplace_back(number_, index - 1);  // a vertex that may still follow
    return static_cast<std::uint32_t>(index - 1);
  }

  void face(Words& words) {
    corners_.clear();
    for (auto word = words.next(); !word.empty() && word[0] != '#'; word = words.next()) corners_.push_back(corner(word));
    if (corners_.size() < 3) fail(fmt::format("a face with {} corners", corners_.size()), "at least three");
    if (part_ == none) part_ = part_number({object_, group_});
    const auto last = *std::max_element(corners_.begin(), corners_.end());
    if (last < mesh_.vertices.size()) {
      for (const auto& t : cutter_.cut(mesh_.vertices, corners_, file_, number_)) mesh_.triangles.push_back(t);
    } else {  // cut where all its vertices are known
      late_.push_back({number_, mesh_.triangles.size(), corners_});
      mesh_.triangles.resize(mesh_.triangles.size() + corners_.size() - 2);
    }
    owner_.resize(mesh_.triangles.size(), part_);
    materials_.resize(owner_.size(), material_);
  }

  void open_group(std::string_view name) {
    group_ = name.empty() ? "default" : std::string(name);
    part_ = none;
    named_ = true;
  }

  void open_object(std::string_view name) {
    const auto [at, fresh] = object_index_.try_emplace(std::string(name), static_cast<std::uint32_t>(objects_.size()));
    if (fresh) objects_.emplace_back(name);
    object_ = at->second;
    group_.clear();
    part_ = none;
    named_ = true;
  }

  std::uint32_t part_number(Part part) {
    const auto [at, fresh] =
        part_index_.try_emplace(fmt::format("{}\n{}", part.object, part.name), static_cast<std::uint32_t>(parts_.size()));
    if (fresh) parts_.push_back(std::move(part));
    return at->second;
  }

  /// Notes the material libraries that a line names, which no output may replace. Whether one of them lies elsewhere: a name may have
  /// blanks, or several be separated by them, so that a word which leaves the folder tells.
  bool outside(std::string_view names) const {
    bool elsewhere = false;
    Words words(names);
    for (auto name = words.next(); !name.empty(); name = words.next()) {
      const std::filesystem::path path(name);
      const auto relative = path.lexically_normal();
      InputRecord::note((std::filesystem::path(file_).parent_path() / path).string());
      elsewhere = elsewhere || path.is_absolute() || (!relative.empty() && *relative.begin() == "..");
    }
    return elsewhere;
  }

  void build() {
    std::vector<std::uint32_t> structure;
    if (named_) {
      structure = add_parts();
    } else {
      owner_ = connected_components(mesh_);
      const std::uint32_t count = owner_.empty() ? 0 : *std::max_element(owner_.begin(), owner_.end()) + 1;
      for (std::uint32_t c = 0; c < count; ++c) structure.push_back(add_structure(plant_, 0, "organ", std::to_string(c + 1)));
    }
    for (auto& organ : owner_) organ = structure[organ];
    add_mesh(plant_, std::move(mesh_), owner_, materials_);
    check_plant(plant_);
  }

  /// Objects that hold groups become structures of their own; all else is an organ right below the plant.
  std::vector<std::uint32_t> add_parts() {
    std::vector<std::vector<std::uint32_t>> of_object(objects_.size());
    for (std::uint32_t p = 0; p < parts_.size(); ++p)
      if (parts_[p].object != none) of_object[parts_[p].object].push_back(p);
    std::vector<std::uint32_t> structure(parts_.size(), none);
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      if (structure[p] != none) continue;
      const Part& part = parts_[p];
      if (part.object == none) {
        structure[p] = add_structure(plant_, 0, "organ", part.name.empty() ? "default" : part.name);
        continue;
      }
      const auto& siblings = of_object[part.object];
      const bool grouped = std::any_of(siblings.begin(), siblings.end(), [&](auto s) { return !parts_[s].name.empty(); });
      const std::uint32_t parent = grouped ? add_structure(plant_, 0, "object", objects_[part.object]) : 0;
      for (const auto s : siblings)
        structure[s] = add_structure(plant_, parent, "organ", parts_[s].name.empty() ? objects_[part.object] : parts_[s].name);
    }
    return structure;
  }

  const std::string& file_;
  long number_ = 0;
  Plant plant_ = empty_plant(clean_name(std::filesystem::path(file_).stem().string()), file_);
  NameIndex material_index_{plant_.materials};
  Mesh mesh_;
  std::vector<std::uint32_t> owner_, materials_, corners_;
  std::vector<std::pair<long, std::int64_t>> ahead_;
  std::vector<LateFace> late_;
  PolygonCutter cutter_;
  std::size_t outside_ = 0;  ///< lines that name material libraries elsewhere
  std::vector<std::string> objects_;
  std::unordered_map<std::string, std::uint32_t> object_index_, part_index_;
  std::vector<Part> parts_;
  std::string group_;
  std::uint32_t object_ = none, part_ = none, material_ = material_index_("");
  bool named_ = false;
};

}  // namespace

Plant read_obj(const std::string& file) {
  return ObjReader(file).read();
}

}  // namespace sunfleck
