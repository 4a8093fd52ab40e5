#include <sunfleck/core/progress.hpp>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

void Progress::check() const {
  if (cancelled()) throw Stopped();
}

Progress& silent() {
  static Progress progress;
  return progress;
}

}  // namespace sunfleck
