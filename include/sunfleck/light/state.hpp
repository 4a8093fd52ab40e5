// One lighting state: what shines, and for how long.
#pragma once

#include <optional>
#include <string>

#include <sunfleck/light/sky.hpp>
#include <sunfleck/light/sun.hpp>

namespace sunfleck {

/// Irradiances, exitances and powers of sources are at most this [W m^-2, umol m^-2 s^-1, W]: sums over any scene stay finite in single
/// precision.
inline constexpr double brightest = 1e12;
/// A state's duration is at most this [s]: three hundred years.
inline constexpr double longest_duration_s = 1e10;

struct LightState {
  std::string name;
  double duration_s = 0.0;  ///< 0 = unknown; daily sums need it
  std::optional<Sun> sun;
  std::optional<Sky> sky;
};

}  // namespace sunfleck
