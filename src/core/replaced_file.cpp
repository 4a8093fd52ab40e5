#include <sunfleck/core/replaced_file.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

}  // namespace

ReplacedFile::ReplacedFile(const std::string& path) : path_(path), target_(path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (path.empty()) throw UsageError("the name of an output file is empty");
  if (fs::is_symlink(path, error)) target_ = fs::weakly_canonical(path, error).string();
  if (fs::is_directory(target_, error)) fail(EISDIR);
  if (fs::exists(target_, error) && !fs::is_regular_file(target_, error))
    throw OutputError(path_ + ": cannot be written: it is a device or a pipe, no file");
  const fs::path place(target_);
  temporary_ = (place.parent_path() / ("." + place.filename().string() + ".partial-" + std::to_string(::getpid()))).string();
  ::unlink(temporary_.c_str());
  descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
}

ReplacedFile::~ReplacedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(temporary_.c_str());
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

void ReplacedFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) fail(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  committed_ = true;
}

}  // namespace sunfleck
