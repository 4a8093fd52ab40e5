// Progress on a terminal or in a log: lasting lines on stderr, a bar on terminals only, signals as cancellation.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include <sunfleck/core/progress.hpp>

namespace sunfleck {

class OverdueStop;

/// From construction on SIGINT, SIGTERM and SIGHUP, unless they were ignored, ask for an orderly stop (cancelled() turns true); a second
/// signal of the kind kills at once.
class TerminalProgress : public Progress {
 public:
  TerminalProgress();
  ~TerminalProgress() override;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  void line(std::string_view text) override;
  void fraction(std::string_view phase, double done) override;
  bool cancelled() const override;
  /// From now on the process ends within half a second of being asked to stop, even where the work does not hear it (see OverdueStop).
  void end_when_overdue();

 private:
  void clear_bar();

  bool terminal_;
  bool bar_shown_ = false;
  std::chrono::steady_clock::time_point last_drawn_{}, phase_began_{};
  std::string phase_;  ///< the one whose bar is shown
  double phase_done_ = 0;
  std::unique_ptr<OverdueStop> overdue_;
};

/// "12 s left", "3 min left", "2 h 10 min left": what a phase still takes that did a share of its work in so many seconds. Empty as long as
/// that is a guess: before a second has passed, or a fiftieth of the work is done.
std::string time_left(double seconds, double done);

}  // namespace sunfleck
