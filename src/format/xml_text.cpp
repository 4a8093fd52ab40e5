#include <format/xml_text.hpp>

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>

namespace sunfleck {

namespace {

/// What <?xml ... encoding="..."?> names, in small letters; empty where it names nothing.
std::string declared(std::string_view text) {
  if (!text.starts_with("<?xml")) return {};
  const std::string_view head = text.substr(0, text.find("?>"));
  const auto key = head.find("encoding");
  const auto open = key == std::string_view::npos ? key : head.find_first_of("\"'", key);
  const auto close = open == std::string_view::npos ? open : head.find(head[open], open + 1);
  if (close == std::string_view::npos) return {};
  std::string name(head.substr(open + 1, close - open - 1));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

bool any_of(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string read_xml(const std::string& file, std::vector<std::string>& notes) {
  const std::string whole = read_whole(file);
  std::string text = without_mark(whole, file);
  if (text.size() != whole.size()) return text;  // a mark says more than the declaration
  const std::string name = declared(text);
  if (any_of(name, {"iso-8859-1", "latin1", "latin-1", "windows-1252", "cp1252"})) return from_windows_1252(text);
  // UTF-16 is known by its bytes, whatever the declaration says
  if (!name.empty() && !any_of(name, {"utf-8", "utf8", "us-ascii", "ascii", "utf-16", "utf16", "utf-32"}))
    return from_charset(text, name, location(file, 1, "encoding"));
  if (is_utf8(text)) return text;
  notes.push_back(fmt::format("{}: its text is no UTF-8{} and is taken for Windows-1252 (Latin-1)", file,
                              name.empty() ? "" : ", which its declaration names,"));
  return from_windows_1252(text);
}

}  // namespace sunfleck
