#include <sunfleck/core/timer.hpp>

namespace sunfleck {

void add_seconds(Timings& timings, const std::string& phase, double seconds) {
  for (auto& [name, total] : timings)
    if (name == phase) {
      total += seconds;
      return;
    }
  timings.emplace_back(phase, seconds);
}

}  // namespace sunfleck
