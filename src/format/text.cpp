#include <format/text.hpp>

#include <charconv>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>

namespace sunfleck {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

}  // namespace

void check_readable(const std::string& file) {
  check_input_file(file);
}

std::string read_whole(const std::string& file) {
  return read_input_file(file);
}

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u; };
    const unsigned lead = byte(0), second = byte(1);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
    if (length == 0) return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(k) & 0xC0) != 0x80) return false;
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) || (lead == 0xF0 && second < 0x90) ||
        (lead == 0xF4 && second > 0x8F))
      return false;
    i += length;
  }
  return true;
}

std::string from_latin1(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xC0 | (code >> 6));
      out += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  return out;
}

bool Lines::raw(std::string_view& line) {
  if (at_ >= text_.size()) return false;
  const std::size_t end = text_.find('\n', at_);
  line = text_.substr(at_, end == std::string_view::npos ? end : end - at_);
  at_ = end == std::string_view::npos ? text_.size() : end + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++line_;
  return true;
}

bool Lines::next(std::string_view& line) {
  if (!raw(line)) return false;
  first_ = line_;
  if (!join_ || line.empty() || line.back() != '\\') return true;
  joined_.clear();
  do {
    line.remove_suffix(1);
    joined_.append(line).push_back(' ');
    if (!raw(line)) line = {};
  } while (!line.empty() && line.back() == '\\');
  joined_.append(line);
  line = joined_;
  return true;
}

std::string_view Words::next() {
  const std::size_t begin = rest_.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return rest_ = {};
  rest_.remove_prefix(begin);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
  rest_.remove_prefix(word.size());
  return word;
}

std::string_view Words::rest() {
  const std::size_t begin = rest_.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return rest_ = {};
  return rest_.substr(begin, rest_.find_last_not_of(blanks) + 1 - begin);
}

bool to_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) {  // 1e-400 is as good as zero, 1e400 is no length
    const bool tiny = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  } else if (error != std::errc{}) {
    return false;
  }
  return end == word.data() + word.size();
}

bool to_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

Vec3 read_point(Words& words, const std::string& file, long line, const char* what) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = words.next();
    double value = 0;
    if (word.empty()) throw InputError(location(file, line), fmt::format("{} with {} coordinates", what, axis), "three numbers");
    if (!to_number(word, value) || !std::isfinite(value))
      throw InputError(location(file, line), fmt::format("{} coordinate {}", what, in_quotes(word)), "a finite number");
    p[axis] = value;
  }
  return p;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, longest)) text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text + (word.size() > longest ? "...\"" : "\"");
}

}  // namespace sunfleck
