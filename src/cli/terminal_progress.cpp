#include "cli/terminal_progress.hpp"

#include <cmath>
#include <csignal>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string>

#include <fmt/format.h>

#include "cli/overdue_stop.hpp"
#include "cli/standard_streams.hpp"

namespace sunfleck {

namespace {

// Set by a handler on whichever thread the signal meets, read by all that work: a volatile sig_atomic_t would be a race between them.
std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void ask_to_stop(int) {
  stop_asked.store(true, std::memory_order_relaxed);
  OverdueStop::asked();
}

void on_signal(int signal) {
  struct sigaction action {};
  // ignored since before we began (nohup, a job in the background): stays so
  if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second one meets the default action and kills
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

constexpr std::chrono::milliseconds redraw_interval{500};

}  // namespace

TerminalProgress::TerminalProgress() : terminal_(isatty(STDERR_FILENO) == 1) {
  on_signal(SIGINT);
  on_signal(SIGTERM);
  on_signal(SIGHUP);
}

TerminalProgress::~TerminalProgress() {
  clear_bar();
}

void TerminalProgress::line(std::string_view text) {
  clear_bar();
  tell(fmt::format("{}\n", text));
}

void TerminalProgress::fraction(std::string_view phase, double done) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (phase != phase_ || done < phase_done_) phase_ = phase, phase_began_ = now;
  phase_done_ = done;
  if (now - last_drawn_ < redraw_interval) return;
  last_drawn_ = now;
  const int width = std::clamp(terminal_columns() - static_cast<int>(phase.size()) - 28, 10, 40);
  const double part = std::clamp(done, 0.0, 1.0);
  const int filled = static_cast<int>(part * width);
  const std::string left = time_left(std::chrono::duration<double>(now - phase_began_).count(), part);
  tell(fmt::format("\r\033[K{} [{}{}] {:3.0f} %{}{}", phase, std::string(static_cast<std::size_t>(filled), '#'),
                   std::string(static_cast<std::size_t>(width - filled), '.'), 100.0 * part, left.empty() ? "" : ", ", left));
  bar_shown_ = true;
}

std::string time_left(double seconds, double done) {
  if (seconds < 1 || !(done >= 0.02)) return {};
  const double left = seconds * (1 - done) / done;
  if (left < 100) return fmt::format("{:.0f} s left", left);
  const long minutes = std::lround(left / 60);
  if (minutes < 100) return fmt::format("{} min left", minutes);
  return fmt::format("{} h {:02} min left", minutes / 60, minutes % 60);
}

void TerminalProgress::end_when_overdue() {
  constexpr std::chrono::milliseconds patience{300};
  overdue_ = std::make_unique<OverdueStop>(patience);
}

bool TerminalProgress::cancelled() const {
  return stop_asked.load(std::memory_order_relaxed);
}

void TerminalProgress::clear_bar() {
  if (!bar_shown_) return;
  tell("\r\033[K");
  bar_shown_ = false;
}

}  // namespace sunfleck
