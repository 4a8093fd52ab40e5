#include <sunfleck/core/replaced_file.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/unfinished_files.hpp>

#include "core/partial_name.hpp"

namespace sunfleck {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
constexpr int most_links = 40, most_tries = 100;

std::string folder_of(const std::string& file) {
  const std::string folder = fs::path(file).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// As the kernel has it where fs.protected_symlinks is set: in a folder that all may write and where each keeps what is his (/tmp), a link
/// of someone else is a trap.
bool is_trap(const std::string& link) {
  struct stat at {
  }, folder{};
  if (::lstat(link.c_str(), &at) != 0 || ::stat(folder_of(link).c_str(), &folder) != 0) return false;
  const bool open_to_all = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
  return open_to_all && at.st_uid != ::geteuid() && at.st_uid != folder.st_uid;
}

}  // namespace

std::string behind_links(const std::string& path, const std::function<void(const std::string&)>& each) {
  fs::path at(path);
  std::error_code error;
  for (int hop = 0; fs::is_symlink(at, error); ++hop) {
    if (each) each(at.string());
    const fs::path next = fs::read_symlink(at, error);
    if (hop == most_links || error) throw OutputError(path + ": cannot be written: " + std::strerror(error ? error.value() : ELOOP));
    at = at.parent_path() / next;
  }
  return at.string();
}

ReplacedFile::ReplacedFile(const std::string& path, Links links) : path_(path), target_(path) {
  if (path.empty()) throw UsageError("the name of an output file is empty");
  if (links == Links::follow)
    target_ = behind_links(path, [&](const std::string& link) {
      if (is_trap(link)) throw OutputError(path_ + ": cannot be written: it is a link that someone else made in a folder open to all");
    });
  look_at_target();
  open_temporary();
}

void ReplacedFile::look_at_target() {
  struct stat old {};
  if (::lstat(target_.c_str(), &old) != 0) {
    if (errno != ENOENT) fail(errno);
    return;
  }
  if (S_ISLNK(old.st_mode)) return;  // replaced itself
  if (S_ISDIR(old.st_mode)) fail(EISDIR);
  if (!S_ISREG(old.st_mode)) throw OutputError(path_ + ": cannot be written: it is a device or a pipe, no file");
  if (::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) fail(errno);
  replaces_ = true, mode_ = old.st_mode & 0777, owner_ = old.st_uid, group_ = old.st_gid;
}

void ReplacedFile::open_temporary() {
  const fs::path place(target_);
  for (int i = 0; i < most_tries; ++i) {
    temporary_ = (place.parent_path() / partial_name(place.filename().string())).string();
    // who may not read what is replaced may not read what replaces it
    const mode_t mode = replaces_ ? (mode_ | S_IRUSR | S_IWUSR) : 0666;
    descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (descriptor_ < 0 && errno == EEXIST) continue;
    if (descriptor_ < 0) fail(errno);
    ::flock(descriptor_, LOCK_SH | LOCK_NB);  // shared, so that HDF5, which locks what it reads, may read it
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) {
      UnfinishedFiles::all().add(temporary_);
      return;
    }
    ::close(std::exchange(descriptor_, -1));  // someone who tidies up has taken it for abandoned just before it was locked
  }
  fail(EEXIST);
}

ReplacedFile::~ReplacedFile() {
  if (old_descriptor_ >= 0) ::close(old_descriptor_);
  if (descriptor_ >= 0 && !committed_) ::unlink(temporary_.c_str());
  UnfinishedFiles::all().forget(temporary_);
  if (descriptor_ < 0) return;
  ::close(descriptor_);
}

void ReplacedFile::fail(int error) const {
  throw OutputError(path_ + ": cannot be written: " + std::strerror(error));
}

void ReplacedFile::write(const void* bytes, std::size_t count) {
  buffer_.append(static_cast<const char*>(bytes), count);
  if (buffer_.size() >= buffer_bytes) flush();
}

void ReplacedFile::flush() {
  const char* bytes = buffer_.data();
  for (std::size_t left = buffer_.size(); left > 0;) {
    const ssize_t put = ::write(descriptor_, bytes, left);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail(put < 0 ? errno : ENOSPC);
    bytes += put;
    left -= static_cast<std::size_t>(put);
  }
  buffer_.clear();
}

void ReplacedFile::commit(std::initializer_list<ReplacedFile*> files) {
  for (auto* file : files) file->flush();
  for (auto* file : files) {
    if (file->replaces_) {  // where the file system or the system does not let us, they stay as they are
      [[maybe_unused]] const int owned = ::fchown(file->descriptor_, file->owner_, file->group_);
      ::fchmod(file->descriptor_, file->mode_);
    }
    if (::fsync(file->descriptor_) != 0) file->fail(errno);
  }
  {
    const auto lock = UnfinishedFiles::all().naming();
    try {
      if (files.size() > 1)
        for (auto* file : files) file->keep_old();
      for (auto* file : files) file->rename_to_target();
    } catch (...) {
      for (auto* file : files) file->roll_back();
      throw;
    }
    for (auto* file : files)
      if (!file->old_.empty()) ::unlink(file->old_.c_str());
  }
  for (auto* file : files) file->sync_folder();
}

void ReplacedFile::keep_old() {
  if (!replaces_) return;
  const fs::path place(target_);
  old_ = (place.parent_path() / partial_name(place.filename().string())).string();
  old_descriptor_ = ::open(target_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (old_descriptor_ >= 0) ::flock(old_descriptor_, LOCK_SH | LOCK_NB);  // in use, for whoever tidies up
  if (::link(target_.c_str(), old_.c_str()) != 0) old_.clear();           // not every file system has second names
}

void ReplacedFile::rename_to_target() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  committed_ = true;
}

void ReplacedFile::roll_back() noexcept {
  if (committed_ && !replaces_) ::unlink(target_.c_str());
  if (old_.empty()) return;
  if (committed_)
    std::rename(old_.c_str(), target_.c_str());
  else
    ::unlink(old_.c_str());
}

void ReplacedFile::sync_folder() const {
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // it may be written and not be read: the name reaches the disk in its own time
  const int error = ::fsync(folder) == 0 ? 0 : errno;
  ::close(folder);
  if (error != 0 && error != EINVAL && error != EROFS && error != ENOTSUP)
    throw OutputError(path_ + ": is written, but its folder could not be brought to the disk: " + std::strerror(error));
}

}  // namespace sunfleck
