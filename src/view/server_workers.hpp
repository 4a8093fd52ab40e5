// Threads that answer what takes time, so that the one which serves the connections never waits.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace sunfleck {

class ServerWorkers {
 public:
  /// As many threads as the system gives, at most `most`; throws OutputError where it gives none.
  ServerWorkers(std::size_t most, std::size_t most_waiting);
  /// Drops what waits and finishes what is being done.
  ~ServerWorkers();
  ServerWorkers(const ServerWorkers&) = delete;
  ServerWorkers& operator=(const ServerWorkers&) = delete;

  /// Does the job, which must not throw, on one of the threads; false, and nothing is done, where too many wait.
  bool take(std::function<void()> job);

 private:
  void work();

  std::size_t most_waiting_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace sunfleck
