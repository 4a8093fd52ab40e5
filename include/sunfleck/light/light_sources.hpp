// The distinct skies and suns of many lighting states.
#pragma once

#include <cstdint>
#include <vector>

#include <sunfleck/light/state.hpp>

namespace sunfleck {

/// States that differ in strength alone share a sky or a sun: what depends on directions is done once for them. Points into the states.
struct LightSources {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::vector<const Sky*> skies;
  std::vector<const Sun*> suns;
  std::vector<std::uint32_t> sky_of_state, sun_of_state;  ///< [s] row of the lists above, or none
};
LightSources light_sources(const std::vector<LightState>& states);

}  // namespace sunfleck
