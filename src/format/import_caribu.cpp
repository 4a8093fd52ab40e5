// CARIBU cases: .can (read as a plant), .opt (optical properties, a band each), .light (directions), .8 (the pattern that repeats).
// As openalea.caribu's file_adaptor.py (OpenAlea) and its Label read them; Chelle & Andrieu 1998, doi:10.1016/S0304-3800(98)00100-8.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/format/caribu_files.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/light/state.hpp>

namespace sunfleck {

namespace {

class Caribu {
 public:
  explicit Caribu(const ImportChoice& choice) : choice_(choice) {
    for (const auto& file : choice.files) {
      const std::string suffix = suffix_of(file);
      if (suffix == ".opt") {
        opts_.push_back(read_opt(file));
      } else if (suffix == ".can" || suffix == ".light" || suffix == ".8") {
        auto& known = suffix == ".can" ? can_ : suffix == ".light" ? light_ : pattern_;
        if (!known.empty()) throw UsageError(fmt::format("{}: found a second {} beside {}; expected one", file, suffix, known));
        known = file;
      } else {
        throw UsageError(fmt::format("{}: found suffix '{}'; expected .ops, or .can with .opt, .light and .8", file, suffix));
      }
    }
    if (can_.empty()) throw UsageError("found no .can; expected one beside .opt, .light and .8");
    std::set<std::string> names;
    for (const auto& opt : opts_)
      if (!names.insert(opt.band).second) throw UsageError(fmt::format("{}: found a second file for the band {}", opt.file, opt.band));
    for (const auto& opt : opts_) bands_.push_back(opt.band);
  }

  ImportedScene scene() {
    static const std::map<std::string, double> units{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}};
    const std::string unit = choice_.unit.value_or("m");
    const auto known = units.find(unit);
    if (known == units.end()) throw UsageError(fmt::format("--unit: found '{}'; expected m, cm, mm, inch or foot", unit));
    const double metre = known->second;
    const Plant plant = read_plant(can_, metre);
    if (bands_.empty()) {
      bands_ = {"PAR"};
      out_.notes.push_back("no .opt: CARIBU's default leaf (reflectance .06, transmittance .07) and soil (.15) in one band, PAR");
    }

    text_ += "bands = [";
    for (std::size_t b = 0; b < bands_.size(); ++b) text_ += (b > 0 ? ", " : "") + toml_text(bands_[b]);
    text_ += "]\n\n";
    std::array<double, 4> cell{};
    if (!pattern_.empty()) {
      cell = read_pattern_file(pattern_);
      for (auto& x : cell)
        if (!(std::fabs(x *= metre) <= farthest_coordinate))
          throw InputError(pattern_, fmt::format("{} m", x),
                           fmt::format("coordinates from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
      text_ += fmt::format("[domain]\nperiodic = [{}, {}, {}, {}]\n\n", cell[0], cell[1], cell[2], cell[3]);
    }
    const auto light = light_.empty() ? std::vector<LightDirection>{{1.0, {0, 0, 1}, 0}} : read_light_file(light_);
    if (light_.empty()) out_.notes.push_back("no .light: CARIBU's default, 1 W m^-2 from the zenith");
    text_ += light_tables(light, bands_, choice_.light_states, out_.notes) + "\n";
    const std::string keys = optics(plant);
    if (choice_.soil) {
      if (pattern_.empty()) throw UsageError("--soil: found no .8; the soil needs the pattern's size");
      text_ += fmt::format("[ground]\nheight = {}\nreflectance = {}\n\n", plant.bounds().low.z, band_table(bands_, soil()));
    }
    text_ += fmt::format("[[plant]]\nname = {}\nfile = {}\nunit = \"{}\"\noptics = {{ {} }}\nplace = [ {{ position = [0, 0, 0] }} ]\n",
                         toml_text(choice_.soil && plant.name == "ground" ? "plants" : plant.name),
                         toml_text(path_from(choice_.output, can_)), unit, keys);
    out_.text = std::move(text_);
    return std::move(out_);
  }

 private:
  std::vector<double> soil() const {
    std::vector<double> out;
    for (const auto& opt : opts_) {
      if (opt.soil < 0) throw InputError(location(opt.file, opt.soil_line), "no reflectance of the soil", "a line \"s d RHO\"");
      out.push_back(opt.soil);
    }
    return opts_.empty() ? std::vector<double>{0.15} : out;
  }

  /// Writes [optics.*] for every species that the .can uses, and returns the plant's keys for them.
  std::string optics(const Plant& plant) {
    std::set<std::pair<std::string, std::string>> used;  // type, material
    for (const auto& shape : plant.shapes)
      used.emplace(plant.types[plant.structures[shape.structure].type], plant.materials[shape.material]);
    std::string keys;
    for (const auto& [type, material] : used) {
      const std::string name = type == "soil" ? "soil" : type + "_" + material;
      const auto key = toml_text(type + "/" + material);
      keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", key, toml_text(name));
      text_ += fmt::format("[optics.{}]\n", name);
      if (type == "soil") {
        text_ += "reflectance = " + band_table(bands_, soil()) + "\n\n";
      } else {
        text_ += species(type, material);
      }
    }
    return keys;
  }

  std::string species(const std::string& type, const std::string& material) {
    if (opts_.empty())
      return type == "leaf" ? "reflectance = { PAR = 0.06 }\ntransmittance = { PAR = 0.07 }\n\n" : "reflectance = { PAR = 0.06 }\n\n";
    const std::size_t number = std::stoul(material.substr(material.find('_') + 1));
    std::vector<double> front, back, through;
    bool uneven = false;
    for (const auto& opt : opts_) {
      if (number < 1 || number > opt.species.size())
        throw InputError(opt.file, fmt::format("{} species", opt.species.size()), fmt::format("species {}, which {} has", number, can_));
      const CaribuOptics::Species& s = opt.species[number - 1];
      const auto given = [&](double value, const char* what) {
        if (value < 0)
          throw InputError(location(opt.file, s.line), fmt::format("no {} of species {}", what, number),
                           fmt::format("one, which {} needs", can_));
        return value;
      };
      if (type != "leaf") {
        front.push_back(given(s.stem, "stem's reflectance"));
        continue;
      }
      front.push_back(given(s.upper_reflectance, "reflectance of the upper side"));
      back.push_back(given(s.lower_reflectance, "reflectance of the lower side"));
      const double up = given(s.upper_transmittance, "transmittance of the upper side");
      const double down = given(s.lower_transmittance, "transmittance of the lower side");
      through.push_back(0.5 * (up + down));
      uneven = uneven || up != down;
    }
    if (uneven)
      out_.notes.push_back(
          fmt::format("species {}: transmittances of the two sides differ; their mean is taken, since light through a leaf is the "
                      "same both ways here",
                      number));
    if (type != "leaf") return "reflectance = " + band_table(bands_, front) + "\n\n";
    const std::string reflectance =
        front == back ? "reflectance = " + band_table(bands_, front) + "\n"
                      : "reflectance_front = " + band_table(bands_, front) + "\nreflectance_back = " + band_table(bands_, back) + "\n";
    return reflectance + "transmittance = " + band_table(bands_, through) + "\n\n";
  }

  const ImportChoice& choice_;
  std::string can_, light_, pattern_, text_;
  std::vector<CaribuOptics> opts_;
  std::vector<std::string> bands_;
  ImportedScene out_;
};

}  // namespace

ImportedScene import_caribu(const ImportChoice& choice) {
  return Caribu(choice).scene();
}

}  // namespace sunfleck
