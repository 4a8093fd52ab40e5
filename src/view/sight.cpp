#include "view/sight.hpp"

#include <algorithm>
#include <cmath>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

Sight::Sight(const DrawnScene& scene, const PlacedRays& rays, const PictureSettings& settings, const std::vector<View>& views)
    : rays_(rays), part_(settings.infinite ? PlacedRays::Part::repeated : PlacedRays::Part::all), cut_(settings.cut) {
  const Vec3 eye = views.front().camera.eye();
  if (cut_) {
    const auto& n = cut_->normal;
    if (!std::isfinite(glm::length(n)) || !(glm::length(n) > 0) || !std::isfinite(glm::length(cut_->point)))
      throw UsageError("--cut: found a plane without a direction; expected finite numbers and a normal above zero");
    cut_->normal = glm::normalize(n);
    if (cut_->facing_eye && glm::dot(eye - cut_->point, cut_->normal) < 0) cut_->normal = -cut_->normal;
  }
  haze_ = 28.0 * glm::length(scene.all_bounds().size());
  clear_ = glm::length(eye - scene.all_bounds().centre());
  far_ = settings.infinite && scene.geometry().periodic ? clear_ + 4 * haze_ : std::numeric_limits<double>::infinity();
}

PlacedHit Sight::hit(const CameraRay& ray) const {
  double from = 0, to = far_;
  if (cut_) {
    // The part of the ray on the side that is kept.
    const double height = glm::dot(ray.origin - cut_->point, cut_->normal), slope = glm::dot(ray.direction, cut_->normal);
    if (slope < 0)
      from = std::max(from, -height / slope);
    else if (slope > 0)
      to = std::min(to, -height / slope);
    else if (height > 0)
      to = -1;
  }
  PlacedHit found = from < to ? rays_.first_hit(ray.origin, ray.direction, part_, from, to) : PlacedHit{};
  if (!cut_) return found;
  // Ground that the cut has bared.
  const auto ground = rays_.first_hit(ray.origin, ray.direction, PlacedRays::Part::ground, 0, far_);
  return ground.distance < found.distance ? ground : found;
}

std::vector<float> read_seen(const SeenFacets& seen, std::size_t facets, std::size_t width, const LightSource::Read& read,
                             Progress& progress, std::size_t block) {
  std::vector<float> out(seen.count() * width);
  for (std::size_t first = 0; first < facets; first += block) {
    if (first % (std::size_t{1} << 17) < block) {
      progress.check();
      progress.fraction("values", static_cast<double>(first) / static_cast<double>(facets));
    }
    const std::size_t count = std::min(block, facets - first);
    if (!seen.any(first, count)) continue;
    const auto values = read(first, count);
    if (values.size() != count * width) throw Error("a picture's values do not match its scene");
    for (std::size_t i = 0; i < count; ++i)
      if (seen.has(first + i)) std::copy_n(&values[i * width], width, &out[seen.row(first + i) * width]);
  }
  return out;
}

}  // namespace sunfleck
