#include <sunfleck/core/unfinished_files.hpp>

#include <algorithm>

#include <unistd.h>

namespace sunfleck {

UnfinishedFiles& UnfinishedFiles::all() {
  static auto* files = new UnfinishedFiles;  // never destroyed: asked until the very end
  return *files;
}

void UnfinishedFiles::add(const std::string& path) {
  const auto lock = naming();
  paths_.push_back(path);
}

void UnfinishedFiles::forget(const std::string& path) {
  const auto lock = naming();
  const auto at = std::find(paths_.begin(), paths_.end(), path);
  if (at != paths_.end()) paths_.erase(at);
}

void UnfinishedFiles::remove() {
  mutex_.lock();  // for good
  for (const auto& path : paths_) ::unlink(path.c_str());
}

}  // namespace sunfleck
