// CARIBU/canestra scenes: lines "p 1 LABEL 3 x y z x y z x y z". A label has 12 digits, from the left: optical species (1, or more in
// longer labels), plant (5), leaf (3), element (3); leaf 000 means opaque (OpenAlea, openalea.caribu.label, Chelle & Andrieu 1998,
// doi:10.1016/S0304-3800(98)00100-8).
#include <sunfleck/format/read_plant.hpp>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <format/polygons.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/plant/build.hpp>

namespace sunfleck {

namespace {

struct Label {
  std::string digits;  ///< at least twelve
  std::int64_t species = 0, plant = 0, leaf = 0, element = 0;

  /// leaves are translucent, stems and soil opaque; soil has species 0
  const char* type() const { return leaf > 0 ? "leaf" : species > 0 ? "stem" : "soil"; }
};

class CanReader {
 public:
  explicit CanReader(const std::string& file) : file_(file) {}

  Plant read() {
    const std::string text = read_text(file_, plant_.notes);
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) {
      number_ = lines.number();
      Words words(line);
      const std::string_view key = words.next();
      if (key.empty() || key[0] == '#') continue;
      if (key != "p") fail(in_quotes(key), "a polygon \"p 1 LABEL 3 x y z ...\" or a comment \"# ...\"");
      polygon(words);
    }
    cutter_.note(file_, plant_.notes);
    build();
    return std::move(plant_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(location(file_, number_), found, expected);
  }

  std::int64_t count(Words& words, const char* what, std::int64_t least) const {
    const std::string_view word = words.next();
    std::int64_t value = 0;
    if (!to_integer(word, value) || value < least)
      fail(fmt::format("{} {}", what, in_quotes(word)), fmt::format("a whole number of at least {}", least));
    return value;
  }

  Label label_of(std::string_view word) const {
    Label label;
    const bool digits = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!digits || word.size() > 18) fail(fmt::format("label {}", in_quotes(word)), "12 digits: species, plant (5), leaf (3), element (3)");
    label.digits = std::string(word.size() < 12 ? 12 - word.size() : 0, '0').append(word);
    const std::string_view all = label.digits;
    const std::size_t n = all.size();
    to_integer(all.substr(0, n - 11), label.species);
    to_integer(all.substr(n - 11, 5), label.plant);
    to_integer(all.substr(n - 6, 3), label.leaf);
    to_integer(all.substr(n - 3, 3), label.element);
    return label;
  }

  void polygon(Words& words) {
    const std::int64_t labels = count(words, "number of labels", 1);
    const std::string_view word = words.next();
    if (word.empty() || word != last_label_) enter(label_of(last_label_ = word));
    for (std::int64_t i = 1; i < labels; ++i)  // further labels say nothing about optics or place
      if (words.next().empty()) fail(fmt::format("{} labels", i), fmt::format("{}", labels));
    const std::int64_t corners = count(words, "number of corners", 3);
    const std::size_t first = mesh_.vertices.size();
    for (std::int64_t i = 0; i < corners; ++i) mesh_.vertices.push_back(read_point(words, file_, number_, "a corner"));
    if (const auto extra = words.next(); !extra.empty() && extra[0] != '#')
      fail(fmt::format("{} after {} corners", in_quotes(extra), corners), "the end of the line");
    corners_.resize(static_cast<std::size_t>(corners));
    std::iota(corners_.begin(), corners_.end(), static_cast<std::uint32_t>(first));
    for (const auto& t : cutter_.cut(mesh_.vertices, corners_, file_, number_)) mesh_.triangles.push_back(t);
    owner_.resize(mesh_.triangles.size(), organ_);
    materials_.resize(mesh_.triangles.size(), material_);
  }

  /// Makes the organ of a label the one that the next triangles belong to.
  void enter(const Label& label) {
    material_ = plant_.material_index(fmt::format("species_{}", label.species));
    const auto [at, fresh] = organ_index_.try_emplace(label.plant * 1000 + label.leaf, static_cast<std::uint32_t>(organs_.size()));
    organ_ = at->second;
    if (!fresh) return;
    const auto [plant, new_plant] = plant_index_.try_emplace(label.plant, static_cast<std::uint32_t>(organs_of_plant_.size()));
    if (new_plant) organs_of_plant_.emplace_back();
    organs_of_plant_[plant->second].push_back(organ_);
    organs_.push_back(label);
  }

  void build() {
    std::vector<std::uint32_t> structure(organs_.size());
    for (const auto& members : organs_of_plant_) {
      const std::int64_t number = organs_[members[0]].plant;
      const std::uint32_t parent = add_structure(plant_, 0, "plant", fmt::format("plant_{}", number));
      set_attribute(plant_, parent, "plant", number);
      for (const auto o : members) {
        const Label& label = organs_[o];
        const std::string name = label.leaf > 0 ? fmt::format("leaf_{}", label.leaf) : label.type();
        structure[o] = add_structure(plant_, parent, label.type(), name);
        set_attribute(plant_, structure[o], "label", label.digits);
        set_attribute(plant_, structure[o], "plant", label.plant);
        set_attribute(plant_, structure[o], "leaf", label.leaf);
        set_attribute(plant_, structure[o], "optical_species", label.species);
        set_attribute(plant_, structure[o], "transparency", std::int64_t{label.leaf > 0});
      }
    }
    for (auto& organ : owner_) organ = structure[organ];
    add_mesh(plant_, std::move(mesh_), owner_, materials_);
    check_plant(plant_);
  }

  const std::string& file_;
  long number_ = 0;
  Plant plant_ = empty_plant(clean_name(std::filesystem::path(file_).stem().string()), file_, "canopy");
  Mesh mesh_;
  PolygonCutter cutter_;
  std::vector<std::uint32_t> owner_, materials_, corners_;
  std::vector<Label> organs_;  ///< the first label of each
  std::vector<std::vector<std::uint32_t>> organs_of_plant_;
  std::unordered_map<std::int64_t, std::uint32_t> organ_index_, plant_index_;
  std::string last_label_;
  std::uint32_t organ_ = 0, material_ = 0;
};

}  // namespace

Plant read_can(const std::string& file) {
  return CanReader(file).read();
}

}  // namespace sunfleck
