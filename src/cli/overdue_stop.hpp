// Ends the process where work does not hear in time that it is to stop.
#pragma once

#include <chrono>
#include <thread>

namespace sunfleck {

/// From construction on, as long as it lives: once asked() was called, work has `patience` to end by itself, so that this is destroyed;
/// else unfinished outputs are removed, "stopped" is said, and the process ends with exit code 4, whatever it is doing: long loops ask
/// whether to stop, but libraries (a tree of rays being built, a file being compressed) and the system do not. One at a time.
class OverdueStop {
 public:
  explicit OverdueStop(std::chrono::milliseconds patience);
  ~OverdueStop();
  OverdueStop(const OverdueStop&) = delete;
  OverdueStop& operator=(const OverdueStop&) = delete;

  /// May be called by a signal handler; nothing happens where there is none.
  static void asked() noexcept;

 private:
  void watch() const;

  const std::chrono::milliseconds patience_;
  int read_ = -1, write_ = -1;  ///< ends of a pipe
  std::thread thread_;
};

}  // namespace sunfleck
