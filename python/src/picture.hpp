// Pictures of light in memory, as bytes of a PNG.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/scene/depth.hpp>
#include <sunfleck/scene/scene.hpp>

namespace sunfleck::python {

struct PictureSize {
  int width, height, samples;
};

/// Natural colour; irradiance [s][n][2][b], sunlit [s][n][2] as solution.hpp has them.
std::string picture_of_scene(const Scene& scene, const Depth& depth, const std::vector<float>& irradiance, const std::vector<float>& sunlit,
                             std::size_t state, const PictureSize& size, Progress& progress);
std::string picture_of_file(const std::string& result, std::size_t state, const PictureSize& size, Progress& progress);

}  // namespace sunfleck::python
