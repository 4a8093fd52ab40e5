#include "cli/sizes_text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace sunfleck {

std::string size_text(const PlantSize& size) {
  return fmt::format("{:.3g} m high, {:.3g} m wide, from {:.3g} m", size.height, size.width, size.lowest);
}

std::string sizes_text(const Scene& scene, const SceneSizes& sizes) {
  constexpr std::size_t most_plants = 8;
  const Box& box = sizes.all;
  std::string text = box.empty() ? std::string("extent none")
                                 : fmt::format("extent x {:.4g} .. {:.4g}, y {:.4g} .. {:.4g}, z {:.4g} .. {:.4g} m", box.low.x, box.high.x,
                                               box.low.y, box.high.y, box.low.z, box.high.z);
  std::size_t placed = 0;
  for (std::size_t p = 0; p < scene.plants.size(); ++p)
    if (sizes.plants[p].placed && ++placed <= most_plants) text += fmt::format("; {} {}", scene.plants[p].name, size_text(sizes.plants[p]));
  if (placed > most_plants) text += fmt::format("; and {} more", placed - most_plants);
  return text;
}

}  // namespace sunfleck
