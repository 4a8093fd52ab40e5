// Wall-clock seconds of named phases.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Phases in the order in which they first ended.
using Timings = std::vector<std::pair<std::string, double>>;  ///< [s]
/// Adds seconds to a phase, appending it if new.
void add_seconds(Timings& timings, const std::string& phase, double seconds);

}  // namespace sunfleck
