#include "lamp_paths.hpp"

#include <sunfleck/scene/lamp_shares.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr int farthest_image = 2000;

/// Row of rising sums in which x lies, and its part of the total.
std::size_t row_at(const std::vector<double>& sums, double x) {
  return std::min<std::size_t>(static_cast<std::size_t>(std::upper_bound(sums.begin(), sums.end(), x * sums.back()) - sums.begin()),
                               sums.size() - 1);
}
double chance(const std::vector<double>& sums, std::size_t row) {
  return (sums[row] - (row > 0 ? sums[row - 1] : 0.0)) / sums.back();
}

}  // namespace

LampPaths::LampPaths(const Scene& scene, double clearance)
    : lamps_(place_lamps(scene)), clearance_(std::max(0.0, clearance)), cell_(scene.periodic) {
  cumulative_ = lamp_shares(lamps_);
  std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
  double sum = 0.0;
  if (cell_)
    for (int i = -farthest_image; i <= farthest_image; ++i) images_.push_back(sum += std::pow(1.0 + std::abs(i), -1.5));
  if (lamps_.faces.empty()) return;
  for (const auto& face : lamps_.faces) {
    faces_.corners.push_back(face.corners);
    faces_.area.push_back(static_cast<float>(face.area));
    for (const auto& c : face.corners) faces_.bounds.add(c);
  }
  faces_.plant_facets = faces_.corners.size();
  faces_.periodic = cell_;
  rays_ = std::make_unique<RayScene>(faces_);
}

Vec3 LampPaths::nearest_image(const Vec3& p, const Vec3& at) const {
  return {std::round((p.x - at.x) / cell_->width()), std::round((p.y - at.y) / cell_->depth()), 0.0};
}

double LampPaths::image_chance(const Vec3& p, const Vec3& at, double i, double j) const {
  const Vec3 near = nearest_image(p, at);
  const double di = i - near.x, dj = j - near.y;
  if (!(std::abs(di) <= farthest_image && std::abs(dj) <= farthest_image)) return 0.0;
  return chance(images_, static_cast<std::size_t>(di + farthest_image)) * chance(images_, static_cast<std::size_t>(dj + farthest_image));
}

LampPaths::Draw LampPaths::draw(const Vec3& p, const Vec3& n, const double* x) const {
  Draw out;
  if (cumulative_.empty() || !(cumulative_.back() > 0.0)) return out;
  const std::size_t row = row_at(cumulative_, x[0]);
  double density = chance(cumulative_, row);
  const bool is_face = row < lamps_.faces.size();
  const auto* beam = is_face ? nullptr : &lamps_.beams[row - lamps_.faces.size()];
  Vec3 to;
  if (is_face) {
    const auto& c = lamps_.faces[row].corners;
    const double root = std::sqrt(x[1]);
    to = c[0] + root * (1.0 - x[2]) * (c[1] - c[0]) + root * x[2] * (c[2] - c[0]);
    out.unit = lamps_.faces[row].unit;
  } else {
    to = beam->point(x[1], x[2]);
    out.unit = beam->unit;
  }
  if (cell_) {
    const Vec3 at = is_face ? lamps_.faces[row].corners[0] : beam->position;
    const std::size_t i = row_at(images_, x[3]), j = row_at(images_, x[4]);
    density *= chance(images_, i) * chance(images_, j);
    const Vec3 near = nearest_image(p, at);
    to.x += (near.x + static_cast<double>(i) - farthest_image) * cell_->width();
    to.y += (near.y + static_cast<double>(j) - farthest_image) * cell_->depth();
  }
  to -= p;
  out.distance = glm::length(to);
  if (!(out.distance > 0.0)) return out;
  out.direction = to / out.distance;
  const double cosine = glm::dot(n, out.direction), square = out.distance * out.distance;
  out.on_front = cosine > 0.0;
  if (is_face) {
    const auto& face = lamps_.faces[row];
    const double there = -glm::dot(face.normal, out.direction);
    if (!(there * out.distance > clearance_)) return out;
    const double by_points = density / face.area * square / there, by_rays = std::abs(cosine) / pi;  // per solid angle
    out.factor = std::abs(cosine) / (pi * (by_points + by_rays));
  } else {
    out.factor = beam->photometry->intensity(beam->to_lamp * -out.direction) * std::abs(cosine) / square / density;
  }
  return out;
}

double LampPaths::crossing_part(const Vec3& p, const Vec3& n, const Vec3& d, const RayHit& hit, double distance) const {
  const auto& face = lamps_.faces[hit.facet];
  const double cosine = std::abs(glm::dot(n, d)), there = std::abs(glm::dot(face.normal, d));
  if (!(there > 0.0)) return 1.0;
  double density = chance(cumulative_, hit.facet);
  if (cell_) {
    const Vec3 met = p + distance * d;
    const Vec3 base = face.corners[0] + hit.u * (face.corners[1] - face.corners[0]) + hit.v * (face.corners[2] - face.corners[0]);
    density *=
        image_chance(p, face.corners[0], std::round((met.x - base.x) / cell_->width()), std::round((met.y - base.y) / cell_->depth()));
  }
  const double by_points = density / face.area * distance * distance / there, by_rays = cosine / pi;
  return by_rays / (by_points + by_rays);
}

}  // namespace sunfleck
