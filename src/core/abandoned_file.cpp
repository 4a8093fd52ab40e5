#include <sunfleck/core/replaced_file.hpp>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sunfleck/core/folder.hpp>

#include "core/partial_name.hpp"

namespace sunfleck {

namespace {

namespace fs = std::filesystem;

constexpr std::time_t just_now = 2;  ///< [s]

/// How long nobody must have written a temporary before it is taken for abandoned [s].
std::time_t patience(PartialName::Kind kind) {
  constexpr std::time_t day = 24 * 3600;
  if (kind == PartialName::Kind::this_boot) return 0;            // its lock tells
  return kind == PartialName::Kind::process_id ? day : 7 * day;  // locks need not reach other machines
}

/// Removes one temporary if nobody writes it any more; its size if so, else -1.
off_t remove_if_abandoned(const std::string& path, PartialName::Kind kind) {
  struct stat named {
  }, opened{};
  if (::lstat(path.c_str(), &named) != 0 || !S_ISREG(named.st_mode)) return -1;
  if (const auto wait = patience(kind); wait > 0 && std::time(nullptr) - named.st_mtime < wait) return -1;
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return -1;
  const bool same = ::fstat(descriptor, &opened) == 0 && opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
  // whoever writes it holds a lock, which ends with him; who has just made it may be about to
  bool free = same && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  if (free && std::time(nullptr) - named.st_mtime <= just_now) {
    ::flock(descriptor, LOCK_UN);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    free = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &opened) == 0 && opened.st_nlink > 0;
  }
  const bool removed = free && ::unlink(path.c_str()) == 0;
  ::close(descriptor);
  return removed ? named.st_size : -1;
}

template <class Wanted>
std::vector<AbandonedFile> remove_where(const fs::path& folder, const Wanted& wanted) {
  std::vector<AbandonedFile> removed;
  for (const auto& name : names_in(folder.string())) {
    const PartialName partial = parse_partial_name(name);
    if (partial.kind == PartialName::Kind::none || !wanted(partial.name)) continue;
    const std::string path = (folder / name).string();
    if (const off_t bytes = remove_if_abandoned(path, partial.kind); bytes >= 0)
      removed.push_back({path, static_cast<std::uint64_t>(bytes)});
  }
  return removed;
}

}  // namespace

std::vector<AbandonedFile> remove_abandoned(const std::string& path) {
  const fs::path target = behind_links(path);
  const std::string name = shortened(target.filename().string());
  return remove_where(target.parent_path(), [&](const std::string& partial) { return partial == name; });
}

std::vector<AbandonedFile> remove_abandoned(const std::string& folder, std::string_view suffix) {
  return remove_where(folder, [&](const std::string& partial) { return partial.ends_with(suffix); });
}

}  // namespace sunfleck
