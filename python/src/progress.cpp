#include "progress.hpp"

#include <chrono>
#include <exception>
#include <optional>
#include <thread>

#include <unistd.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck::python {

namespace {

/// A thread that stays for the next work: the scheduler (oneTBB) keeps some kilobytes for every thread that it has met.
class Worker {
 public:
  /// Does one piece of work; returns at once.
  void start(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
    wanted_.notify_one();
  }

  /// One that is idle, or a new one; of this process (a fork has none of its parent's threads).
  static Worker* take() {
    const std::lock_guard lock(idle_mutex());
    auto& all = idle();
    while (!all.empty()) {
      Worker* worker = all.back();
      all.pop_back();
      if (worker->process_ == getpid()) return worker;
    }
    auto* worker = new Worker;  // never ended: nothing is to wait for it when the interpreter ends
    std::thread([worker] { worker->run(); }).detach();
    return worker;
  }
  static void give_back(Worker* worker) {
    const std::lock_guard lock(idle_mutex());
    idle().push_back(worker);
  }

 private:
  static std::mutex& idle_mutex() {
    static auto* mutex = new std::mutex;
    return *mutex;
  }
  static std::vector<Worker*>& idle() {
    static auto* all = new std::vector<Worker*>;
    return *all;
  }

  [[noreturn]] void run() {
    for (;;) {
      std::unique_lock lock(mutex_);
      wanted_.wait(lock, [&] { return static_cast<bool>(work_); });
      const auto work = std::exchange(work_, nullptr);
      lock.unlock();
      work();
    }
  }

  std::mutex mutex_;
  std::condition_variable wanted_;
  std::function<void()> work_;
  pid_t process_ = getpid();
};

}  // namespace

void Relay::line(std::string_view text) {
  const std::lock_guard lock(mutex_);
  lines_.push_back({"", -1, std::string(text)});
}

void Relay::fraction(std::string_view phase, double done) {
  const std::lock_guard lock(mutex_);
  newest_ = {std::string(phase), done, ""};
}

std::vector<Relay::Word> Relay::heard() {
  const std::lock_guard lock(mutex_);
  std::vector<Word> out;
  out.swap(lines_);
  if (newest_.fraction >= 0) out.push_back(newest_);
  newest_.fraction = -1;
  return out;
}

void while_python_listens(const py::object& progress, const std::function<void(Progress&)>& work) {
  Relay relay;
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  std::exception_ptr failure;
  std::optional<py::error_already_set> raised;
  const auto listen = [&] {  // with the interpreter's lock
    if (raised) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const auto words = relay.heard();
      if (progress.is_none()) return;
      for (const auto& word : words) {
        const bool is_line = word.fraction < 0;
        progress(word.phase, is_line ? py::object(py::none()) : py::float_(word.fraction),
                 is_line ? py::object(py::str(word.line)) : py::none());
      }
    } catch (py::error_already_set& error) {
      raised.emplace(std::move(error));
      relay.cancel();
    }
  };
  {
    const py::gil_scoped_release released;
    Worker* worker = Worker::take();
    worker->start([&] {
      try {
        work(relay);
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();  // with the lock: what is captured lives until it is released
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
      lock.unlock();
      {
        const py::gil_scoped_acquire acquired;
        listen();
      }
      lock.lock();
    }
    lock.unlock();
    Worker::give_back(worker);
  }
  if (!failure) listen();
  if (raised) throw std::move(*raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sunfleck::python
