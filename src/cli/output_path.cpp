#include "cli/output_path.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <sunfleck/core/companion_file.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/core/names.hpp>
#include <sunfleck/core/replaced_file.hpp>
#include <sunfleck/view/export.hpp>

#include <sunfleck/core/text_units.hpp>

namespace sunfleck {

namespace {

namespace fs = std::filesystem;

std::string suffix_of(const std::string& file) {
  std::string suffix = fs::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

/// What is written beside a file, checked to be ours to write; empty where nothing is.
std::string checked_companion(const std::string& file) {
  const std::string suffix = suffix_of(file);
  const std::string beside = suffix == ".obj" ? material_library_beside(file) : suffix == ".xdmf" ? heavy_data_beside(file) : "";
  std::error_code ignored;
  if (beside.empty() || !fs::exists(fs::symlink_status(beside, ignored))) return beside;
  if (!(suffix == ".obj" ? is_our_material_library(beside) : is_our_heavy_data(beside)))
    throw UsageError(
        fmt::format("{}: found {}, which is written beside it and is there already, not by sunfleck; expected another name", file, beside));
  return beside;
}

/// Whether two names are one file, or will be once they are written.
bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path first = fs::weakly_canonical(behind_links(a), error), second = fs::weakly_canonical(behind_links(b), error);
  return !error && first == second;
}

}  // namespace

void check_output_path(const std::string& file, const std::vector<std::string>& suffixes, const std::vector<std::string>& inputs) {
  const fs::path path(file);
  const std::string suffix = suffix_of(file);
  if (std::find(suffixes.begin(), suffixes.end(), suffix) == suffixes.end())
    throw UsageError(fmt::format("{}: found suffix '{}'; expected {}", file, suffix, joined(suffixes)));
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw UsageError(fmt::format("{}: found a directory; expected a file to write", file));
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    throw UsageError(fmt::format("{}: found a device or a pipe; expected a file to write", file));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw UsageError(fmt::format("{}: found no folder '{}'; expected one that exists", file, folder.string()));
  for (const auto& input : inputs)
    if (fs::equivalent(path, input, ignored))
      throw UsageError(fmt::format("{}: found the input file; expected another name to write to", file));
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw OutputError(fmt::format("{}: no permission to write in '{}'", file, folder.string()));
}

void prepare_outputs(const std::vector<std::string>& files, Progress& progress) {
  std::vector<std::string> written = files;
  for (const auto& file : files)
    if (auto beside = checked_companion(file); !beside.empty()) written.push_back(std::move(beside));
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (const auto input = InputRecord::input_behind(written[i]))
      throw UsageError(*input == written[i]
                           ? fmt::format("{}: found an input file; expected another name to write to", written[i])
                           : fmt::format("{}: found the input file {}; expected another name to write to", written[i], *input));
    for (std::size_t k = 0; k < i; ++k)
      if (same_file(written[i], written[k]))
        throw UsageError(fmt::format("{}: found the same file as {}; expected two files to write", written[i], written[k]));
  }
  for (const auto& file : written)
    for (const auto& left : remove_abandoned(file))
      progress.line(
          fmt::format("note: removed {}, {} that a run that was killed had left", left.path, bytes_text(static_cast<double>(left.bytes))));
}

}  // namespace sunfleck
