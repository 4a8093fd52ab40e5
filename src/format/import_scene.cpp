#include <sunfleck/format/import_scene.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include <format/import_parts.hpp>
#include <format/text.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/utf8.hpp>

namespace sunfleck {

std::string toml_text(const std::string& text) {
  if (!is_utf8(text)) throw InputError(in_quotes(text), "bytes that are no UTF-8", "a name in UTF-8, as scene files are");
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + "\"";
}

std::string band_table(const std::vector<std::string>& bands, const std::vector<double>& values) {
  std::string out = "{ ";
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const bool bare = !bands[b].empty() && std::all_of(bands[b].begin(), bands[b].end(), [](unsigned char c) {
      return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-');
    });
    out += fmt::format("{}{} = {}", b > 0 ? ", " : "", bare ? bands[b] : toml_text(bands[b]), values[b]);
  }
  return out + " }";
}

std::string path_from(const std::string& scene, const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(fs::path(scene)).parent_path();
  std::error_code error;
  const fs::path path = fs::proximate(fs::absolute(file), folder, error);
  return (error ? fs::absolute(file) : path).generic_string();
}

std::string suffix_of(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

ImportedScene import_scene(const ImportChoice& choice) {
  std::vector<std::string> ops;
  for (const auto& file : choice.files)
    if (suffix_of(file) == ".ops") ops.push_back(file);
  if (ops.empty()) return import_caribu(choice);
  if (choice.files.size() > 1) throw UsageError(fmt::format("{}: found other files beside it; an .ops is imported alone", ops[0]));
  return import_amap(choice, ops[0]);
}

}  // namespace sunfleck
