// Filling PictureLayers pixel by pixel; costs nothing where they are not wanted.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <sunfleck/view/picture.hpp>
#include <sunfleck/view/placed_rays.hpp>

#include "view/layout.hpp"

namespace sunfleck {

class PixelLayers {
 public:
  PixelLayers(const PictureSettings& settings, const DrawnScene& scene, bool with_value) : scene_(scene) {
    if (settings.layers) layers_.emplace().resize(settings.width, settings.height, with_value);
  }

  /// What the middle sample of a pixel meets.
  void middle(int x, int y, const View& view, const CameraRay& ray, const PlacedHit& hit,
              float value = std::numeric_limits<float>::quiet_NaN()) {
    if (!layers_ || !hit) return;
    const std::size_t i = at(x, y);
    layers_->depth[i] = static_cast<float>(glm::dot(ray.origin + hit.distance * ray.direction - view.camera.eye(), view.camera.forward()));
    layers_->organ[i] = scene_.organ(scene_.place(hit.facet));
    layers_->facet[i] = hit.facet < no_row ? static_cast<std::uint32_t>(hit.facet) : no_row;
    if (!layers_->value.empty()) layers_->value[i] = value;
  }
  /// Mean colour over a pixel, multiplied by alpha.
  void mean(int x, int y, const Rgb& colour, float alpha) {
    if (!layers_) return;
    const std::size_t i = at(x, y);
    layers_->red[i] = colour.r, layers_->green[i] = colour.g, layers_->blue[i] = colour.b, layers_->alpha[i] = alpha;
  }
  std::optional<PictureLayers> take() { return std::move(layers_); }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(layers_->width) + static_cast<std::size_t>(x);
  }

  const DrawnScene& scene_;
  std::optional<PictureLayers> layers_;
};

}  // namespace sunfleck
