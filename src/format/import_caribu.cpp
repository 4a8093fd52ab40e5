// CARIBU cases: .can (read as a plant), .opt (optical properties, a band each), .light (directions), .8 (the pattern that repeats).
// As openalea.caribu's file_adaptor.py (OpenAlea) and its Label read them; Chelle & Andrieu 1998, doi:10.1016/S0304-3800(98)00100-8.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/light/state.hpp>

namespace sunfleck {

namespace {

/// One optical species: a stem's reflectance, then reflectance and transmittance of a leaf's upper and lower side; -1 = not given.
struct OptSpecies {
  double stem, upper_reflectance, upper_transmittance, lower_reflectance, lower_transmittance;
  long line;
};

struct OptFile {
  std::string file, band;
  double soil = -1;
  long soil_line = 0;
  std::vector<OptSpecies> species;
};

/// Calls visit(words, number) for each line of a text file.
template <class Visit>
void each_line(const std::string& file, Visit&& visit) {
  std::vector<std::string> ignored;  // comments, of which nothing is kept
  const std::string text = read_text(file, ignored);
  Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    Words words(line);
    visit(words, lines.number());
  }
}

class OptReader {
 public:
  explicit OptReader(const std::string& file) : file_(file) {
    out_.file = file;
    out_.band = clean_name(std::filesystem::path(file).stem().string());
    std::string upper = out_.band;
    std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (upper == "PAR" || upper == "NIR") out_.band = upper;
  }

  OptFile read() {
    std::int64_t promised = -1;
    each_line(file_, [&](Words& words, long number) {
      line_ = number;
      const std::string_view key = words.next();
      if (key.empty() || key[0] == '#') return;
      if (key[0] == 'n') {
        if (!to_integer(words.next(), promised) || promised < 1) fail("n without a number of species", "\"n 2\"");
      } else if (key[0] == 's') {
        lambertian(words);
        out_.soil = fraction(words, "the soil's reflectance");
        out_.soil_line = line_;
      } else if (key[0] == 'e') {
        species(words);
      } else {
        fail(in_quotes(key), "n, s or e, or a comment \"# ...\"");
      }
    });
    line_ = 0;
    if (out_.species.empty()) fail("no species", "lines \"e d RHO  d RHO TAU  d RHO TAU\"");
    if (promised >= 0 && static_cast<std::size_t>(promised) != out_.species.size())
      fail(fmt::format("{} species", out_.species.size()), fmt::format("the {} that line n tells of", promised));
    return out_;
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(location(file_, line_), found, expected);
  }

  void lambertian(Words& words) const {
    const auto word = words.next();
    if (word != "d") fail(fmt::format("{}", in_quotes(word)), "\"d\": diffuse, the only kind of surface there is here");
  }

  double fraction(Words& words, const char* what) const {
    const auto word = words.next();
    double value = 0;
    if (!to_number(word, value) || !(value <= 1) || !(value >= 0 || value == -1))
      fail(fmt::format("{} = {}", what, in_quotes(word)), "a number from 0 to 1, or -1 for none");
    return value;
  }

  void species(Words& words) {
    OptSpecies s{};
    s.line = line_;
    lambertian(words), s.stem = fraction(words, "the stem's reflectance");
    lambertian(words), s.upper_reflectance = fraction(words, "the upper side's reflectance");
    s.upper_transmittance = fraction(words, "the upper side's transmittance");
    lambertian(words), s.lower_reflectance = fraction(words, "the lower side's reflectance");
    s.lower_transmittance = fraction(words, "the lower side's transmittance");
    out_.species.push_back(s);
  }

  const std::string& file_;
  long line_ = 0;
  OptFile out_;
};

std::vector<LightDirection> read_light(const std::string& file) {
  std::vector<LightDirection> out;
  double sum = 0;
  each_line(file, [&](Words& words, long number) {
    const auto first = words.next();
    if (first.empty() || first[0] == '#') return;
    const auto where = location(file, number);
    double energy = 0;
    if (!to_number(first, energy) || !std::isfinite(energy) || energy < 0)
      throw InputError(where, fmt::format("energy {}", in_quotes(first)),
                       "a number that is not negative: irradiance of a horizontal plane");
    const Vec3 v = read_point(words, file, number, "a direction");
    if (!words.rest().empty()) throw InputError(where, in_quotes(words.rest()), "four numbers: energy and direction");
    const Vec3 towards = -glm::normalize(v / std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}));  // no square overflows
    if (!(towards.z > 0)) throw InputError(where, fmt::format("direction {} {} {}", v.x, v.y, v.z), "one that goes down (z below 0)");
    sum += energy;
    if (!(energy / towards.z <= brightest) || !(sum <= brightest))
      throw InputError(where, fmt::format("energy {}", energy), fmt::format("a beam, and a sum of all, of at most {:g} W m^-2", brightest));
    if (energy > 0) out.push_back({energy, towards, number});
  });
  if (out.empty()) throw InputError(file, "no light", "lines \"ENERGY VX VY VZ\" with an energy above zero");
  return out;
}

/// xmin, ymin, xmax, ymax in the file's unit.
std::array<double, 4> read_pattern(const std::string& file) {
  std::vector<double> values;
  each_line(file, [&](Words& words, long number) {
    for (auto word = words.next(); !word.empty() && word[0] != '#'; word = words.next()) {
      double value = 0;
      if (!to_number(word, value) || !std::isfinite(value)) throw InputError(location(file, number), in_quotes(word), "a finite number");
      values.push_back(value);
    }
  });
  if (values.size() != 4) throw InputError(file, fmt::format("{} numbers", values.size()), "four: xmin ymin, and below xmax ymax");
  if (!(values[2] > values[0]) || !(values[3] > values[1]))
    throw InputError(file, fmt::format("{} {} to {} {}", values[0], values[1], values[2], values[3]),
                     "xmax above xmin, and ymax above ymin");
  return {values[0], values[1], values[2], values[3]};
}

class Caribu {
 public:
  explicit Caribu(const ImportChoice& choice) : choice_(choice) {
    for (const auto& file : choice.files) {
      const std::string suffix = suffix_of(file);
      if (suffix == ".opt") {
        opts_.push_back(OptReader(file).read());
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
      cell = read_pattern(pattern_);
      for (auto& x : cell)
        if (!(std::fabs(x *= metre) <= farthest_coordinate))
          throw InputError(pattern_, fmt::format("{} m", x),
                           fmt::format("coordinates from {:g} to {:g} m", -farthest_coordinate, farthest_coordinate));
      text_ += fmt::format("[domain]\nperiodic = [{}, {}, {}, {}]\n\n", cell[0], cell[1], cell[2], cell[3]);
    }
    const auto light = light_.empty() ? std::vector<LightDirection>{{1.0, {0, 0, 1}, 0}} : read_light(light_);
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
      const OptSpecies& s = opt.species[number - 1];
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
  std::vector<OptFile> opts_;
  std::vector<std::string> bands_;
  ImportedScene out_;
};

}  // namespace

ImportedScene import_caribu(const ImportChoice& choice) {
  return Caribu(choice).scene();
}

}  // namespace sunfleck
