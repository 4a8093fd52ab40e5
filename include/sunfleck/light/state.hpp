// One lighting state: what shines, and for how long.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/light/sky.hpp>
#include <sunfleck/light/sun.hpp>

namespace sunfleck {

struct LightState {
  std::string name;
  double duration_s = 0.0;  ///< 0 = unknown; daily sums need it
  std::optional<Sun> sun;
  std::optional<Sky> sky;
};

}  // namespace sunfleck
