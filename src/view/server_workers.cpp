#include "view/server_workers.hpp"

#include <system_error>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

ServerWorkers::ServerWorkers(std::size_t most, std::size_t most_waiting) : most_waiting_(most_waiting) {
  threads_.reserve(most);
  try {
    while (threads_.size() < most) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error& error) {
    if (threads_.empty()) throw OutputError(std::string("the viewer cannot start a thread: ") + error.code().message());
  }
}

ServerWorkers::~ServerWorkers() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    jobs_.clear();
  }
  wake_.notify_all();
  for (auto& thread : threads_) thread.join();
}

bool ServerWorkers::take(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    if (ended_ || jobs_.size() >= most_waiting_) return false;
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
  return true;
}

void ServerWorkers::work() {
  for (;;) {
    std::function<void()> job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return ended_ || !jobs_.empty(); });
      if (ended_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job();
  }
}

}  // namespace sunfleck
