// A file that is complete or absent: grows under a temporary name in the same folder, takes its own name at the end.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

/// Where writing to `path` would end: at the end of its symbolic links, be anything there or not. Calls each(link) for every link on the
/// way. Throws OutputError if they go in a circle.
std::string behind_links(const std::string& path, const std::function<void(const std::string&)>& each = {});

/// What was there before stays until commit(); destroyed earlier, only the temporary is removed. The temporary,
/// ".NAME.partial-BOOT-RANDOM", is a new file that nobody else can have opened or linked to; it is locked as long as it grows, so that what
/// a killed process left behind can be told from it (remove_abandoned). What replaces a file has its permissions, and its owner and group
/// where that is allowed. Throws OutputError with the system's words.
class ReplacedFile {
 public:
  /// What becomes of a symbolic link of that name.
  enum class Links {
    follow,  ///< stays a link: what it points to is replaced, be it there or not
    replace  ///< is replaced itself
  };

  /// Throws OutputError if the folder cannot be written, if `path` is something else than a file or is write-protected, or if it is a link
  /// that someone else has put into a folder that all may write.
  explicit ReplacedFile(const std::string& path, Links links = Links::follow);
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
  /// Writes the buffer out: what is at temporary() can then be read.
  void flush();
  /// Writes the buffer out, waits for the disk, and renames.
  void commit() { commit({this}); }
  /// The same for files that belong together: all of them or none.
  static void commit(std::initializer_list<ReplacedFile*> files);
  /// Throws OutputError: "PATH: cannot be written: " and what an errno means.
  [[noreturn]] void fail(int error) const;

 private:
  void look_at_target();
  void open_temporary();
  void keep_old();
  void rename_to_target();
  void roll_back() noexcept;
  void sync_folder() const;

  std::string path_, target_, temporary_, buffer_;
  std::string old_;  ///< while several files are renamed: a second name of what was there
  mode_t mode_ = 0;  ///< of what is replaced
  bool replaces_ = false, committed_ = false;
  uid_t owner_ = 0;
  gid_t group_ = 0;
  int descriptor_ = -1, old_descriptor_ = -1;
};

/// Removes what processes that were killed have left of `path`: temporaries of this machine that no one has locked, and those of other
/// machines, or of this one before it was started anew, that have not been touched for a week.
struct AbandonedFile {
  std::string path;
  std::uint64_t bytes;
};
std::vector<AbandonedFile> remove_abandoned(const std::string& path);
/// The same for all files of a folder whose names end in `suffix`.
std::vector<AbandonedFile> remove_abandoned(const std::string& folder, std::string_view suffix);

}  // namespace sunfleck
