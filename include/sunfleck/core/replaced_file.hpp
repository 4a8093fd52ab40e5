// A file that is complete or absent: grows under a temporary name in the same folder, takes its own name at the end.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sunfleck {

/// What was there before stays until commit(); destroyed earlier, only the temporary is removed (a process that is killed leaves
/// ".NAME.partial-PID" behind). A symbolic link stays a link: what it points to is replaced. Throws OutputError with the system's words.
class ReplacedFile {
 public:
  /// Throws OutputError if the folder cannot be written or `path` is something else than a file.
  explicit ReplacedFile(const std::string& path);
  ~ReplacedFile();
  ReplacedFile(const ReplacedFile&) = delete;
  ReplacedFile& operator=(const ReplacedFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  /// Open for reading and writing; belongs to this object.
  int descriptor() const { return descriptor_; }

  /// Appends through a buffer.
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Writes the buffer out. Where several files belong together, each is written out before the first is committed.
  void flush();
  /// Writes the buffer out, waits for the disk, and renames.
  void commit();
  /// Throws OutputError: "PATH: cannot be written: " and what an errno means.
  [[noreturn]] void fail(int error) const;

 private:
  std::string path_, target_, temporary_, buffer_;
  int descriptor_ = -1;
  bool committed_ = false;
};

}  // namespace sunfleck
