#include <sunfleck/core/input_file.hpp>

#include <atomic>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

std::atomic<InputRecord*> newest{nullptr};

[[noreturn]] void refuse_mode(const std::string& file, mode_t mode) {
  if (S_ISDIR(mode)) throw InputError(file, "a folder", "a file");
  if (S_ISFIFO(mode)) throw InputError(file, "a pipe", "a file");
  throw InputError(file, "a device or socket", "a file");
}

[[noreturn]] void refuse_unreadable(const std::string& file, int error) {
  if (error == ENOENT || error == ENOTDIR) throw InputError(file, "no such file", "an existing file");
  if (error == EACCES) throw InputError(file, "a file that cannot be opened", "permission to read it");
  throw InputError(file, std::string("a file that cannot be read (") + std::strerror(error) + ")", "one that can");
}

class Descriptor {
 public:
  explicit Descriptor(const std::string& file) : value_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

}  // namespace

void check_input_file(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) refuse_unreadable(file, errno);
  if (!S_ISREG(status.st_mode)) refuse_mode(file, status.st_mode);
  InputRecord::note(file);
}

std::string read_input_file(const std::string& file) {
  check_input_file(file);
  const Descriptor in(file);
  struct stat status {};
  if (in.get() < 0 || ::fstat(in.get(), &status) != 0) refuse_unreadable(file, errno);
  if (!S_ISREG(status.st_mode)) refuse_mode(file, status.st_mode);  // it became something else meanwhile
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t filled = 0;
  for (;;) {
    if (filled == bytes.size()) {  // at the end, unless the file has grown or has no size, as those of /proc
      char more[4096];
      const ssize_t got = ::read(in.get(), more, sizeof more);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) refuse_unreadable(file, errno);
      if (got == 0) break;
      bytes.append(more, static_cast<std::size_t>(got));
      filled = bytes.size();
      continue;
    }
    const ssize_t got = ::read(in.get(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse_unreadable(file, errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

InputRecord::InputRecord() : outer_(newest.exchange(this)) {}

InputRecord::~InputRecord() {
  newest = outer_;
}

void InputRecord::note(const std::string& file) {
  InputRecord* record = newest;
  if (!record) return;
  const std::lock_guard lock(record->mutex_);
  record->files_.insert(file);
}

std::optional<std::string> InputRecord::input_behind(const std::string& output) {
  InputRecord* record = newest;
  struct stat there {
  }, read{};
  if (!record || ::stat(output.c_str(), &there) != 0) return {};
  const std::lock_guard lock(record->mutex_);
  if (record->files_.contains(output)) return output;
  for (const auto& file : record->files_)
    if (::stat(file.c_str(), &read) == 0 && read.st_dev == there.st_dev && read.st_ino == there.st_ino) return file;
  return {};
}

}  // namespace sunfleck
