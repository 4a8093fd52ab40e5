// Temporary files of outputs that are being written: what a process that must end at once takes away with it.
#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace sunfleck {

/// Kept by ReplacedFile. Any number of threads.
class UnfinishedFiles {
 public:
  static UnfinishedFiles& all();

  void add(const std::string& path);
  void forget(const std::string& path);
  /// As long as it is held, finished files take their names, and remove() waits.
  std::unique_lock<std::recursive_mutex> naming() { return std::unique_lock(mutex_); }
  /// Removes them, and lets no file take its name any more: to be called right before the process ends.
  void remove();

 private:
  std::recursive_mutex mutex_;
  std::vector<std::string> paths_;
};

}  // namespace sunfleck
