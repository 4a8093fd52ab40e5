// Files that a test writes for itself and removes again.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

/// A file in a fresh folder of its own; `name` is the path that messages show when `path` is cut from them.
class TextFile {
 public:
  TextFile(const std::string& name, std::string_view content) {
    static int count = 0;
    folder_ = std::filesystem::temp_directory_path() / ("sunfleck_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(folder_);
    path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << content;
  }
  ~TextFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  std::string folder() const { return folder_.string(); }
  std::string path;

 private:
  std::filesystem::path folder_;
};

/// The text of the InputError that a call throws, without the folder of the file; empty if it throws none.
template <class Call>
std::string message_of(const TextFile& file, Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string folder = file.folder() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder)) text.erase(at, folder.size());
    return text;
  }
  return {};
}

/// A file of SUNFLECK_EXTRA_DATA, or an empty path where that is not set or has no such file.
inline std::string extra_data(const std::string& name) {
  const char* folder = std::getenv("SUNFLECK_EXTRA_DATA");
  if (!folder) return {};
  const auto path = std::filesystem::path(folder) / name;
  return std::filesystem::exists(path) ? path.string() : std::string{};
}

}  // namespace sunfleck
