#include <sunfleck/format/caribu_files.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>
#include <sunfleck/light/state.hpp>

#include <format/text.hpp>

namespace sunfleck {

namespace {

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

  CaribuOptics read() {
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
    CaribuOptics::Species s{};
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
  CaribuOptics out_;
};

}  // namespace

CaribuOptics read_opt(const std::string& file) {
  return OptReader(file).read();
}

std::vector<LightDirection> read_light_file(const std::string& file) {
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

std::array<double, 4> read_pattern_file(const std::string& file) {
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

}  // namespace sunfleck
