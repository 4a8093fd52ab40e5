// Generated poplars, no two alike, in a row.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/scene/scene.hpp>

#include "places.hpp"

namespace young_poplars {

/// Of three years, 2 m apart, as plants of a scene whose optics are those of leaves and of bark. `policy`: a file's path, or none.
inline std::vector<sunfleck::PlantEntry> entries(std::uint32_t count, const std::string& policy) {
  using namespace sunfleck;
  std::vector<PlantEntry> out;
  for (std::uint32_t k = 0; k < count; ++k) {
    PlantEntry entry;
    entry.name = "poplar_" + std::to_string(k);
    entry.plant = std::make_shared<const Plant>(read_species_plant(SUNFLECK_SOURCE_DIR "/plants/poplar.toml", 3.0, k + 1));
    for (const auto& shape : entry.plant->shapes)
      entry.shape_optics.push_back(entry.plant->types[entry.plant->structures[shape.structure].type] == "leaf" ? 0 : 1);
    entry.policy_file = policy;
    entry.placements = {{Affine::translate({2.0 * k, 0, 0}) * Affine::turn(k)}};
    out.push_back(std::move(entry));
  }
  return out;
}

/// A scene file of three, under sun and sky. `more`: lines of each plant.
inline std::string scene_text(int years, int metres_apart, const std::string& more = {}) {
  std::string text =
      "bands = [\"PAR\", \"NIR\"]\n[sun]\nelevation = 42.0\nazimuth = 225.0\nirradiance = { PAR = 390.0, NIR = 440.0 }\n"
      "[sky]\nmodel = \"clear\"\nirradiance = { PAR = 75.0, NIR = 40.0 }\n"
      "[optics.leaf]\nreflectance = { PAR = 0.1, NIR = 0.45 }\ntransmittance = { PAR = 0.05, NIR = 0.42 }\n"
      "[optics.bark]\nreflectance = { PAR = 0.2, NIR = 0.4 }\n";
  for (int i = 1; i <= 3; ++i)
    text += fmt::format("[[plant]]\nname = \"poplar_{0}\"\nfile = \"" SUNFLECK_SOURCE_DIR
                        "/plants/poplar.toml\"\nage = {1}\nseed = {0}\n{2}optics = {{ leaf = \"leaf\", bark = \"bark\" }}\n"
                        "place = [ {{ position = [{3}, 0, 0] }} ]\n",
                        i, years, more, i * metres_apart);
  return text;
}

}  // namespace young_poplars
