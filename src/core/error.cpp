#include <sunfleck/core/error.hpp>

namespace sunfleck {

InputError::InputError(const std::string& where, const std::string& found, const std::string& expected)
    : Error(where + ": found " + found + "; expected " + expected) {}

Stopped::Stopped() : Error("stopped before the end; nothing was written under the result's name") {}

std::string location(const std::string& file, long line, const std::string& key) {
  std::string where = file.empty() ? "scene in memory" : file;
  if (line > 0) where += ":" + std::to_string(line);
  if (!key.empty()) where += ": " + key;
  return where;
}

}  // namespace sunfleck
