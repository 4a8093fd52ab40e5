#include "cli/overdue_stop.hpp"

#include <atomic>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/unfinished_files.hpp>

#include "cli/standard_streams.hpp"

namespace sunfleck {

namespace {

constexpr char stop = 's', end = 'e';
constexpr int exit_stopped = 4;  // exit code

std::atomic<int> pipe_of_current{-1};
static_assert(std::atomic<int>::is_always_lock_free);

/// The next word; `end` where the pipe is broken or, with a limit, nothing comes in time.
char next_word(int descriptor, int limit_ms, char late) {
  pollfd one{descriptor, POLLIN, 0};
  int ready = 0;
  do ready = ::poll(&one, 1, limit_ms);
  while (ready < 0 && errno == EINTR);
  if (ready == 0) return late;
  char word = end;
  return ready > 0 && ::read(descriptor, &word, 1) == 1 ? word : end;
}

}  // namespace

OverdueStop::OverdueStop(std::chrono::milliseconds patience) : patience_(patience) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  read_ = ends[0], write_ = ends[1];
  try {
    thread_ = std::thread([this] { watch(); });
  } catch (const std::system_error&) {  // no thread to be had: work that asks stops all the same
    return;
  }
  pipe_of_current.store(write_);
}

OverdueStop::~OverdueStop() {
  pipe_of_current.store(-1);
  if (write_ >= 0) ::close(write_);  // which the watcher reads as the end: closing cannot fail to be heard, as writing can
  if (thread_.joinable()) thread_.join();
  if (read_ >= 0) ::close(read_);
}

void OverdueStop::asked() noexcept {
  const int before = errno, pipe = pipe_of_current.load();
  if (pipe >= 0) [[maybe_unused]]
    const auto written = ::write(pipe, &stop, 1);
  errno = before;
}

void OverdueStop::watch() const {
  if (next_word(read_, -1, end) != stop) return;
  const auto until = std::chrono::steady_clock::now() + patience_;
  for (auto left = patience_; left.count() > 0;
       left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()))
    if (next_word(read_, static_cast<int>(left.count()), stop) == end) return;
  UnfinishedFiles::all().remove();
  tell(fmt::format("sunfleck: {}\n", Stopped().what()));
  ::_exit(exit_stopped);
}

}  // namespace sunfleck
