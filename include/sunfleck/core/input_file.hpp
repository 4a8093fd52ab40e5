// Files that are read: opened in one place, which takes files alone and can remember what was read, so that no output takes its place.
#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace sunfleck {

/// Throws InputError unless `file` is there and is a file: a pipe may block for ever, a device need not end. Records it.
void check_input_file(const std::string& file);

/// All bytes of a file; never blocks. Throws InputError if it is missing, no file, or cannot be read. Records it.
std::string read_input_file(const std::string& file);

/// While one lives, what is read is remembered, and what that names (a material library that is not read, the policy of a plant). Without
/// one nothing is: a library's user may well write back what he has read. Files may be read by several threads.
class InputRecord {
 public:
  InputRecord();
  ~InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;

  /// Adds a file to the newest record, if there is any. The file need not be there.
  static void note(const std::string& file);
  /// The recorded file that writing `output` would replace, in whatever spelling, through whatever link; nothing if there is none.
  static std::optional<std::string> input_behind(const std::string& output);

 private:
  InputRecord* outer_;  ///< the record that was the newest before
  std::mutex mutex_;
  std::set<std::string> files_;
};

}  // namespace sunfleck
