// A folder of things that can be made anew, by the hash of all that they depend on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <sunfleck/core/progress.hpp>

namespace sunfleck {

/// An entry's bytes: a line that names its format, its key, a checksum, what it holds.
std::string sealed(const std::string& format_line, const std::string& key, std::string_view payload);
/// What a sealed entry holds; nothing where it is of another format or key, or damaged.
std::optional<std::string_view> payload_of(std::string_view entry, const std::string& format_line, const std::string& key);

/// One file an entry, KEY + suffix, KEY of 64 hexadecimal digits. Complete or absent: entries grow under a temporary name and are renamed,
/// so that any number of processes share a folder without locks. Beyond the limit those that were not used for longest go; other files of
/// the folder are left alone. A folder that cannot be made, read or written costs a message, once, and time.
class CacheFolder {
 public:
  /// An empty folder name is no cache. `without`: what the message says is done without it: "originals are measured".
  CacheFolder(std::string folder, std::string suffix, std::uint64_t limit_bytes, std::string without, Progress& progress);

  const std::string& folder() const { return folder_; }
  bool off() const { return folder_.empty(); }
  /// The bytes of an entry, which is then used now; whether they are sound, the caller finds out. `there` tells that something has the
  /// name.
  std::optional<std::string> find(const std::string& key, bool& there) const;
  /// False if it could not be written, or is larger than the limit.
  bool store(const std::string& key, std::string_view bytes);

 private:
  std::string path(const std::string& key) const;
  bool is_entry_name(const std::string& name) const;
  void warn(const std::string& text);
  void shrink(const std::string& newest) const;

  std::string folder_, suffix_;
  std::uint64_t limit_bytes_;
  std::string without_;
  Progress& progress_;
  bool warned_ = false;
};

}  // namespace sunfleck
