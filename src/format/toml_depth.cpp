#include <format/toml_depth.hpp>

#include <algorithm>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr int most_parts = 32;

/// Where a string that opens at `at` ends: behind its closing quotes, or at the end of the line or the text where it is broken.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  if (text.substr(at, 3) == three) {
    std::size_t end = at + 3;
    while (end < text.size() && text.substr(end, 3) != three) end += quote == '"' && text[end] == '\\' ? 2 : 1;
    return std::min(end + 3, text.size());
  }
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != quote && text[end] != '\n') end += quote == '"' && text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

}  // namespace

void check_toml_keys(std::string_view text, const std::string& file) {
  long line = 1;
  int dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = end_of_string(text, at);
      for (; at < end; ++at) line += text[at] == '\n';
      continue;
    }
    if (c == '#') {
      while (at < text.size() && text[at] != '\n') ++at;
      continue;
    }
    if (c == '\n') ++line;
    if (c == '.')
      ++dots;
    else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}')
      dots = 0;
    if (dots >= most_parts)
      throw InputError(location(file, line), "a key of more than " + std::to_string(most_parts) + " parts between dots",
                       "keys of this format, which have a few");
    ++at;
  }
}

}  // namespace sunfleck
