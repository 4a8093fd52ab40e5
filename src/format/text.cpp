#include <format/text.hpp>

#include <iconv.h>

#include <cerrno>
#include <charconv>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/utf8.hpp>

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

std::string from_charset(std::string_view bytes, const std::string& charset, const std::string& where) {
  const std::string known = "UTF-8, UTF-16, ISO-8859-1, windows-1252, or another that iconv knows";
  const iconv_t converter = iconv_open("UTF-8", charset.c_str());
  if (converter == reinterpret_cast<iconv_t>(-1)) throw InputError(where, "text in the character set " + in_quotes(charset), known);
  std::string out, chunk(1 << 16, '\0');
  char* from = const_cast<char*>(bytes.data());  // iconv writes nothing there
  std::size_t left = bytes.size(), result = 0;
  do {
    char* to = chunk.data();
    std::size_t room = chunk.size();
    result = iconv(converter, &from, &left, &to, &room);
    out.append(chunk.data(), chunk.size() - room);
  } while (result == static_cast<std::size_t>(-1) && errno == E2BIG);
  iconv_close(converter);
  if (result == static_cast<std::size_t>(-1))
    throw InputError(where, fmt::format("bytes that are no {} (at byte {})", charset, bytes.size() - left), "text in that character set");
  return out;
}

std::string without_mark(std::string bytes, const std::string& file) {
  const auto begins = [&](std::string_view mark) { return std::string_view(bytes).starts_with(mark); };
  using namespace std::string_view_literals;
  if (begins("\xEF\xBB\xBF"sv)) return bytes.erase(0, 3);
  if (begins("\xFF\xFE\0\0"sv) || begins("\0\0\xFE\xFF"sv))
    return from_charset(std::string_view(bytes).substr(4), bytes[0] == 0 ? "UTF-32BE" : "UTF-32LE", file);
  if (begins("\xFF\xFE"sv) || begins("\xFE\xFF"sv))
    return from_charset(std::string_view(bytes).substr(2), begins("\xFE"sv) ? "UTF-16BE" : "UTF-16LE", file);
  if (bytes.size() < 4 || bytes.size() % 2 != 0 || (bytes[0] == 0) == (bytes[1] == 0) || (bytes[0] == 0) != (bytes[2] == 0) ||
      (bytes[1] == 0) != (bytes[3] == 0))
    return bytes;
  return from_charset(bytes, bytes[0] == 0 ? "UTF-16BE" : "UTF-16LE", file);
}

std::string read_text(const std::string& file, std::vector<std::string>& notes) {
  std::string text = without_mark(read_whole(file), file);
  if (is_utf8(text)) return text;
  notes.push_back(fmt::format("{}: its text is no UTF-8 and is taken for Windows-1252 (Latin-1)", file));
  return from_windows_1252(text);
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
  if (!continues_ || !line.ends_with('\\') || !continues_(line)) return true;
  joined_.clear();
  do {
    line.remove_suffix(1);
    joined_.append(line).push_back(' ');
    if (!raw(line)) line = {};
  } while (line.ends_with('\\') && line.find('#') == std::string_view::npos);  // no comment goes on
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

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(Words(line.substr(0, comma)).rest());
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
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
  const bool whole = word.size() <= longest;
  std::size_t end = whole ? word.size() : longest;
  for (int back = 0; !whole && back < 3 && (static_cast<unsigned char>(word[end]) & 0xC0) == 0x80; ++back) --end;  // not inside a letter
  std::string text = "\"";
  for (const char c : as_utf8(word.substr(0, end))) text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text + (whole ? "\"" : "...\"");
}

}  // namespace sunfleck
