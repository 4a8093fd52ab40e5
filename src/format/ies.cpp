// IES LM-63: a header of keyword lines, a line TILT=..., then numbers that may be broken into lines anywhere.
#include <sunfleck/format/ies.hpp>

#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include <format/text.hpp>

namespace sunfleck {

namespace {

/// The numbers after the TILT line, in turn; commas separate as blanks do.
class Numbers {
 public:
  Numbers(const std::string& file, Lines& lines) : file_(file), lines_(lines) {}

  double next(const std::string& what) {
    std::string_view word;
    while ((word = take()).empty())
      if (std::string_view line; lines_.next(line))
        rest_ = line;
      else
        throw InputError(location(file_, lines_.number()), "the end of the file", what);
    double value = 0;
    if (!to_number(word, value)) throw InputError(where(), in_quotes(word), what);
    if (!std::isfinite(value)) throw InputError(where(), in_quotes(word), what + ", finite");
    return value;
  }

  std::size_t count(const std::string& what, std::size_t low, std::size_t high) {
    const double value = next(what);
    if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) || value != std::floor(value))
      throw InputError(where(), fmt::format("{} {}", value, what), fmt::format("a whole number from {} to {}", low, high));
    return static_cast<std::size_t>(value);
  }

  std::vector<double> list(std::size_t count, const std::string& what) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(next(fmt::format("{}, {} of {}", what, i + 1, count)));
    return values;
  }

  void nothing_more() {
    for (std::string_view line = rest_;;) {
      const auto at = line.find_first_not_of(" \t\r,\x1a");  // some writers end with the end-of-file character of DOS
      if (at != std::string_view::npos) throw InputError(where(), in_quotes(line.substr(at)), "nothing after the last intensity");
      if (!lines_.next(line)) return;
    }
  }

  std::string where() const { return location(file_, lines_.number()); }

 private:
  std::string_view take() {
    const auto begin = rest_.find_first_not_of(" \t,");
    if (begin == std::string_view::npos) return rest_ = {};
    const auto end = std::min(rest_.find_first_of(" \t,", begin), rest_.size());
    const auto word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

  const std::string& file_;
  Lines& lines_;
  std::string_view rest_;
};

std::string_view trimmed(std::string_view line) {
  return Words(line).rest();
}

/// Reads on to the line TILT=..., and says what follows the equals sign.
std::string find_tilt(const std::string& file, Lines& lines) {
  std::string_view line;
  while (lines.next(line)) {
    line = trimmed(line);
    if (line.substr(0, 5) == "TILT=" || line.substr(0, 5) == "TILT ") {
      const auto equals = line.find('=');
      if (equals == std::string_view::npos) throw InputError(location(file, lines.number()), in_quotes(line), "TILT=NONE or TILT=INCLUDE");
      return std::string(trimmed(line.substr(equals + 1)));
    }
  }
  throw InputError(location(file), "no line TILT=...", "an IES LM-63 photometric file");
}

/// LM-63 of 2002 marks round openings by negative lengths; earlier editions by a negative width alone.
void read_opening(double width, double length, double unit, Photometry& out) {
  out.round = width < 0.0 || length < 0.0;
  width = std::abs(width) * unit, length = std::abs(length) * unit;
  if (out.round && length == 0.0) length = width;
  if (out.round && width == 0.0) width = length;
  out.width_m = width, out.length_m = length;
}

}  // namespace

Photometry read_ies(const std::string& file) {
  std::vector<std::string> ignored;  // words of the header, which nothing keeps
  const std::string text = read_text(file, ignored);
  Lines lines(text);
  const std::string tilt = find_tilt(file, lines);
  Photometry out;
  out.file = file;
  Numbers numbers(file, lines);
  if (tilt == "INCLUDE") {
    numbers.count("the lamp's place in the luminaire, 1 to 3", 1, 3);
    const std::size_t pairs = numbers.count("pairs of tilt angle and factor", 1, 10000);
    numbers.list(2 * pairs, "tilt angles and factors");
  } else if (tilt.empty()) {
    throw InputError(numbers.where(), "TILT= without a value", "TILT=NONE, TILT=INCLUDE or TILT=FILE");
  }
  numbers.next("the number of lamps");
  numbers.next("lumens per lamp");
  numbers.next("the multiplier of candela values");
  const std::size_t vertical = numbers.count("vertical angles", 2, 100000), horizontal = numbers.count("horizontal angles", 1, 100000);
  if (vertical * horizontal > 10'000'000)
    throw InputError(numbers.where(), fmt::format("{} by {} angles", vertical, horizontal), "at most 10000000 intensities");
  const std::size_t type = numbers.count("the type of photometry, 1 (C), 2 (B) or 3 (A)", 1, 3);
  if (type != 1)
    throw InputError(numbers.where(), fmt::format("photometry of type {}", type == 2 ? 'B' : 'A'),
                     "type C (1), which has its poles at nadir and zenith");
  const double unit = numbers.count("the unit of lengths, 1 (feet) or 2 (metres)", 1, 2) == 1 ? 0.3048 : 1.0;
  const double width = numbers.next("the width of the luminous opening"), length = numbers.next("the length of the luminous opening");
  numbers.next("the height of the luminous opening");
  read_opening(width, length, unit, out);
  numbers.next("the ballast factor");
  numbers.next("the ballast-lamp factor, or 1");
  numbers.next("the input watts");
  const std::string angles = numbers.where();
  out.vertical_deg = numbers.list(vertical, "vertical angles");
  out.horizontal_deg = numbers.list(horizontal, "horizontal angles");
  out.candela = numbers.list(vertical * horizontal, "candela values");
  numbers.nothing_more();
  prepare_photometry(out, angles);
  return out;
}

}  // namespace sunfleck
