// Work of the library in a thread of its own, while Python's main thread looks for Ctrl-C and tells how far the work is.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <sunfleck/core/progress.hpp>

namespace sunfleck::python {

namespace py = pybind11;

/// Keeps what the library says until the calling thread hands it to Python.
class Relay final : public Progress {
 public:
  void line(std::string_view text) override;
  void fraction(std::string_view phase, double done) override;
  bool cancelled() const override { return cancelled_; }
  void cancel() { cancelled_ = true; }

  /// What was said since the last call: (phase, fraction, line); fraction < 0 with a line. At most one fraction, the newest.
  struct Word {
    std::string phase;
    double fraction;
    std::string line;
  };
  std::vector<Word> heard();

 private:
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;
  std::vector<Word> lines_;
  Word newest_{"", -1, ""};
};

/// Does `work` in a thread of its own, the interpreter's lock released; every 50 ms looks for signals (which Python handles in its main
/// thread alone) and calls progress(phase, fraction, line) if it is not None. Whatever Python raises there ends the work and is raised
/// again, once the work has ended. Throws what the work throws.
void while_python_listens(const py::object& progress, const std::function<void(Progress&)>& work);

}  // namespace sunfleck::python
