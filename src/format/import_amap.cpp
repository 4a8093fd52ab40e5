// AMAPstudio's Open Plant Scene (.ops): a terrain, and plants with their places. As amapstudio.cirad.fr describes it, ARCHIMED uses it, and
// PlantGeom.jl (VEZY) reads it: turned about z, scaled, inclined, moved; angles in radians, places in metres, plants in centimetres.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/format/read_plant.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr double most_scale = 1e6;

struct Object {
  std::string file, group;
  Vec3 position{0.0};
  double scale = 1, azimuth = 0, inclination = 0, turn = 0;  ///< [rad] from +x over +y
  long line = 0;
};

class OpsReader {
 public:
  OpsReader(const ImportChoice& choice, const std::string& file) : choice_(choice), file_(file) {}

  ImportedScene scene() {
    read();
    write();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(location(file_, line_), found, expected);
  }

  double coordinate(std::string_view word, const char* what) const {
    const double value = number(word, what);
    if (!(std::fabs(value) <= farthest_coordinate))
      fail(fmt::format("{} {}", what, in_quotes(word)),
           fmt::format("a number from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
    return value;
  }

  double number(std::string_view word, const char* what) const {
    double value = 0;
    if (!to_number(word, value) || !std::isfinite(value)) fail(fmt::format("{} {}", what, in_quotes(word)), "a finite number");
    return value;
  }

  void read() {
    const std::string text = read_text(file_, out_.notes);
    Lines lines(text);
    std::string_view line;
    std::set<std::int64_t> ids;
    std::vector<std::pair<std::int64_t, Object>> objects;
    while (lines.next(line)) {
      line_ = lines.number();
      const auto fields = split(line);
      if (fields.empty()) continue;
      if (fields[0][0] == '#') {
        comment(line);
      } else if (fields[0] == "T") {
        terrain(fields);
      } else if (fields.size() == 3) {
        continue;  // "motherId sceneId date" of scenarios
      } else {
        std::int64_t id = 0, object = 0;
        if (!to_integer(fields[0], id)) continue;  // polylines, polygons and whatever else an editor keeps
        if (fields.size() < 4 || !to_integer(fields[1], object))
          fail(fmt::format("{} fields", fields.size()),
               "sceneId, objectId, file, x, y, z, scale, inclinationAzimut, inclinationAngle, rotation");
        ids.insert(id);
        objects.emplace_back(id, this->object(fields));
      }
    }
    line_ = 0;
    if (objects.empty()) fail("no plant", "lines \"sceneId objectId file x y z scale ...\"");
    std::int64_t wanted = *ids.begin();
    if (choice_.scene_id) {
      wanted = *choice_.scene_id;
      if (!ids.contains(wanted))
        throw UsageError(fmt::format("--scene: found {}; expected one of those in {}: {}", wanted, file_, fmt::join(ids, ", ")));
    } else if (ids.size() > 1) {
      throw UsageError(fmt::format("--scene: found nothing; {} holds scenes {}", file_, fmt::join(ids, ", ")));
    }
    for (auto& [id, object] : objects)
      if (id == wanted) objects_.push_back(std::move(object));
  }

  /// Fields between tabs, or between blanks where the line has no tabs.
  static std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> out;
    const bool tabs = line.find('\t') != std::string_view::npos && line.substr(0, 2) != "T ";
    const std::string_view blanks = tabs ? "\t\r" : " \t\r";
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
      std::string_view field = line.substr(at, end - at);
      while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
      while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
      if (!field.empty()) out.emplace_back(field);
      at = line.find_first_not_of(blanks, end);
    }
    return out;
  }

  void comment(std::string_view line) {
    constexpr std::string_view mark = "[Archimed]";
    if (const auto at = line.find(mark);
        at != std::string_view::npos && line.substr(0, at).find_first_not_of("# \t") == std::string_view::npos) {
      Words words(line.substr(at + mark.size()));
      group_ = words.rest();
    } else if (line.find("inclinationAzimut") != std::string_view::npos) {
      scaled_ = line.find("scale") != std::string_view::npos;
    }
  }

  void terrain(const std::vector<std::string>& fields) {
    if (fields.size() < 6) fail(fmt::format("{} fields of the terrain", fields.size()), "T xOrigin yOrigin zOrigin xSize ySize flat");
    if (fields.size() > 6 && fields[6] != "flat")
      fail(in_quotes(fields[6]), "\"flat\"; other terrains are a mesh of [ground] in the scene file");
    for (std::size_t i = 0; i < 5; ++i) terrain_[i] = coordinate(fields[i + 1], "terrain");
    if (!(terrain_[3] > terrain_[0]) || !(terrain_[4] > terrain_[1]))
      fail(fmt::format("a terrain from {} {} to {} {}", terrain_[0], terrain_[1], terrain_[3], terrain_[4]), "boundaries above the origin");
    has_terrain_ = true;
  }

  Object object(const std::vector<std::string>& fields) {
    const std::size_t needed = scaled_ ? 10 : 9;
    if (fields.size() < needed)
      fail(fmt::format("{} fields", fields.size()),
           fmt::format("{}: sceneId, objectId, file, x, y, z, {}inclinationAzimut, inclinationAngle, rotation", needed,
                       scaled_ ? "scale, " : ""));
    Object o;
    o.line = line_;
    o.group = group_;
    o.file = (std::filesystem::path(file_).parent_path() / fields[2]).string();
    o.position = {coordinate(fields[3], "x"), coordinate(fields[4], "y"), coordinate(fields[5], "z")};
    std::size_t at = 6;
    if (scaled_) o.scale = number(fields[at++], "scale");
    if (o.scale < 0 || o.scale > most_scale)
      fail(fmt::format("scale {}", o.scale), fmt::format("a number above zero and up to {:g}, or 0 for none", most_scale));
    if (o.scale == 0) o.scale = 1, ++without_scale_;
    for (double* angle : {&o.azimuth, &o.inclination, &o.turn}) {
      *angle = number(fields[at++], "angle");
      if (choice_.degrees)
        *angle *= pi / 180;
      else if (std::fabs(*angle) > 2 * pi + 1e-6)
        fail(fmt::format("an angle of {}", *angle), "radians, at most a full turn; --degrees where the file has degrees");
    }
    return o;
  }

  /// A plant's optics: organs called leaf are leaves, the rest is bark.
  std::string optics(const std::string& file) const {
    const Plant plant = read_plant(file);
    std::set<std::string> types;
    for (const auto& shape : plant.shapes) types.insert(plant.types[plant.structures[shape.structure].type]);
    std::string keys;
    bool others = types.size() > 1;
    for (const auto& type : types) {
      std::string lower = type;
      std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const bool leaf = lower.find("leaf") != std::string::npos || lower.find("blade") != std::string::npos || lower == "feuille";
      if (leaf) keys += fmt::format("{} = \"leaf\", ", toml_text(type));
      others = others || !leaf;
    }
    if (keys.empty()) return "\"*\" = \"leaf\"";
    return others ? keys + "\"*\" = \"bark\"" : keys.substr(0, keys.size() - 2);
  }

  static std::string degrees(double angle_rad) { return fmt::format("{:.12g}", angle_rad * 180 / pi); }

  void write() {
    std::string text =
        "# Optics and light are not part of an .ops: these are typical ones. Put your own here.\nbands = [\"PAR\", \"NIR\"]\n\n";
    out_.notes.push_back(
        "an .ops has no optics and no light: typical leaves and bark under an overcast sky were written, to be replaced by your own");
    if (without_scale_ > 0) out_.notes.push_back(fmt::format("{} objects have a scale of 0, which is none: taken for 1", without_scale_));
    const bool periodic = has_terrain_ && !choice_.finite;
    if (periodic) {
      text += fmt::format("[domain]\nperiodic = [{}, {}, {}, {}]\n\n", terrain_[0], terrain_[1], terrain_[3], terrain_[4]);
      out_.notes.push_back("the terrain repeats without end, as ARCHIMED's toric scenes do (--finite for one that does not)");
    }
    text += "[sky]\nmodel = \"standard_overcast\"\nirradiance = { PAR = 200.0, NIR = 180.0 }\n\n";
    text += "[optics.leaf]\nreflectance = { PAR = 0.10, NIR = 0.45 }\ntransmittance = { PAR = 0.05, NIR = 0.40 }\n\n";
    text += "[optics.bark]\nreflectance = { PAR = 0.15, NIR = 0.35 }\n\n";
    if (has_terrain_) {
      text += "[ground]\n";
      if (!periodic)
        text += fmt::format("size = [{}, {}]\ncenter = [{}, {}]\n", terrain_[3] - terrain_[0], terrain_[4] - terrain_[1],
                            0.5 * (terrain_[0] + terrain_[3]), 0.5 * (terrain_[1] + terrain_[4]));
      text += fmt::format("height = {}\nreflectance = {{ PAR = 0.15, NIR = 0.25 }}\n\n", terrain_[2]);
    }
    const std::string unit = choice_.unit.value_or("cm");
    std::vector<std::pair<std::string, std::string>> plants;  // file and group, in the order of their first object
    for (const auto& o : objects_)
      if (std::find(plants.begin(), plants.end(), std::pair{o.file, o.group}) == plants.end()) plants.emplace_back(o.file, o.group);
    std::set<std::string> names;
    if (has_terrain_) names.insert("ground");  // what results call the ground
    for (const auto& plant : plants) {
      const auto &file = plant.first, &group = plant.second;  // clang 14 lets no lambda capture a structured binding
      const auto first =
          std::find_if(objects_.begin(), objects_.end(), [&](const Object& o) { return o.file == file && o.group == group; });
      line_ = first->line;
      std::error_code none;  // a name too long, a folder without access: no file either
      if (!std::filesystem::exists(file, none)) fail(fmt::format("no file {}", file), "a plant file");
      std::string base = clean_name(group.empty() ? std::filesystem::path(file).stem().string() : group);
      std::replace(base.begin(), base.end(), '/', '_');
      std::string name = base;
      for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
      text += fmt::format("[[plant]]\nname = {}\nfile = {}\nunit = \"{}\"\noptics = {{ {} }}\nplace = [\n", toml_text(name),
                          toml_text(path_from(choice_.output, file)), unit, optics(file));
      for (const auto& o : objects_) {
        if (o.file != file || o.group != group) continue;
        text += fmt::format("  {{ position = [{}, {}, {}]", o.position.x, o.position.y, o.position.z);
        if (o.scale != 1) text += fmt::format(", scale = {}", o.scale);
        if (o.turn != 0) text += ", turn = " + degrees(o.turn);
        if (o.inclination != 0) {  // leans towards azimuth from +x over +y; ours counts from +y over +x, and tilts go from 0 to 180
          const double inclination = std::remainder(o.inclination, 2 * pi), lean = inclination < 0 ? o.azimuth + pi : o.azimuth;
          text += fmt::format(", tilt = {}, tilt_azimuth = {}", degrees(std::fabs(inclination)),
                              degrees(std::remainder(pi / 2 - lean, 2 * pi)));
        }
        text += " },\n";
      }
      text += "]\n\n";
    }
    out_.text = std::move(text);
  }

  const ImportChoice& choice_;
  const std::string& file_;
  long line_ = 0;
  std::string group_;
  bool scaled_ = true, has_terrain_ = false;
  std::array<double, 5> terrain_{};
  std::size_t without_scale_ = 0;
  std::vector<Object> objects_;
  ImportedScene out_;
};

}  // namespace

ImportedScene import_amap(const ImportChoice& choice, const std::string& ops) {
  return OpsReader(choice, ops).scene();
}

}  // namespace sunfleck
