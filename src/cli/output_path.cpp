#include "cli/output_path.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

void check_output_path(const std::string& file, const std::vector<std::string>& suffixes, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  const fs::path path(file);
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(suffixes.begin(), suffixes.end(), suffix) == suffixes.end())
    throw UsageError(fmt::format("{}: found suffix '{}'; expected {}", file, suffix, joined(suffixes)));
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw UsageError(fmt::format("{}: found a directory; expected a file to write", file));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw UsageError(fmt::format("{}: found no folder '{}'; expected one that exists", file, folder.string()));
  for (const auto& input : inputs)
    if (fs::equivalent(path, input, ignored))
      throw UsageError(fmt::format("{}: found the input file; expected another name to write to", file));
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw OutputError(fmt::format("{}: no permission to write in '{}'", file, folder.string()));
}

}  // namespace sunfleck
