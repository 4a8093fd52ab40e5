// Progress with physics in it, and cancellation.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

namespace sunfleck {

/// Receives what long work has to say. The library calls it from one thread at a time; the default does nothing.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A lasting line: a phase begun, an iteration with its residual, a warning about what was dropped.
  virtual void line(std::string_view text) { (void)text; }
  /// Fraction done [0, 1] of the phase named; shown as a bar that is redrawn, at most twice a second, on terminals only.
  virtual void fraction(std::string_view phase, double done) { (void)phase, (void)done; }
  /// True once the user wants to stop; long loops ask at least every 100 ms and throw Stopped.
  virtual bool cancelled() const { return false; }
  /// Throws Stopped if cancelled.
  void check() const;
};

/// A Progress that says nothing and never cancels.
Progress& silent();

}  // namespace sunfleck
