#include <sunfleck/view/camera.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check(const CameraChoice& c) {
  if ((c.eye && !finite(*c.eye)) || (c.target && !finite(*c.target)) || !std::isfinite(c.azimuth_deg))
    throw UsageError("camera: found a value that is not finite; expected finite coordinates and angles");
  if (!(c.elevation_deg >= -90 && c.elevation_deg <= 90))
    throw UsageError(fmt::format("--elevation: found {:g}; expected degrees in [-90, 90]", c.elevation_deg));
  if (!(c.field_of_view_deg > 0 && c.field_of_view_deg <= 170))
    throw UsageError(fmt::format("--fov: found {:g}; expected degrees above 0 and at most 170", c.field_of_view_deg));
}

/// Smallest and largest coordinate of the points along an axis.
std::array<double, 2> extent(std::span<const Vec3> points, const Vec3& axis) {
  std::array<double, 2> e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& p : points) {
    const double d = glm::dot(p, axis);
    e = {std::min(e[0], d), std::max(e[1], d)};
  }
  return e;
}

}  // namespace

Camera::Camera(const CameraChoice& choice, std::span<const Vec3> points, double aspect, const Frame& frame)
    : orthographic_(choice.orthographic) {
  check(choice);
  Box box;
  for (const auto& p : points) box.add(p);
  const Vec3 middle = choice.target ? *choice.target : box.empty() ? Vec3{0.0} : box.centre();
  if (choice.eye) {
    const Vec3 d = middle - *choice.eye;
    if (!(glm::length(d) > 0)) throw UsageError("camera: found the same point as eye and target; expected two different points");
    forward_ = glm::normalize(d);
  } else {
    const double a = choice.azimuth_deg * degree, e = choice.elevation_deg * degree;
    forward_ = -Vec3{std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
  }
  // Looking straight down or up, the top of the picture is north (down) or south (up), turned by the azimuth.
  Vec3 side = glm::cross(forward_, Vec3{0, 0, 1});
  if (glm::length(side) < 1e-9) {
    const double a = choice.eye ? std::numbers::pi : choice.azimuth_deg * degree;
    side = Vec3{-std::cos(a), std::sin(a), 0};
  }
  right_ = glm::normalize(side);
  up_ = glm::cross(right_, forward_);

  // The frame's edges as tangents (or fractions of half the picture) to the left, right, top and bottom of the axis.
  const double left = 1 - 2 * frame.left, right = 2 * frame.right - 1, top = 1 - 2 * frame.top, bottom = 2 * frame.bottom - 1;
  const double distance = std::max(1.0, 2 * glm::length(box.size()));
  if (orthographic_) {
    const auto x = extent(points, right_), y = extent(points, up_);
    double cx = glm::dot(middle, right_), cy = glm::dot(middle, up_), half = 1.0;
    if (!points.empty()) {
      if (choice.eye || choice.target) {
        half = std::max({(x[1] - cx) / (right * aspect), (cx - x[0]) / (left * aspect), (y[1] - cy) / top, (cy - y[0]) / bottom});
      } else {
        half = std::max({(x[1] - x[0]) / ((left + right) * aspect), (y[1] - y[0]) / (top + bottom), choice.least_half_height});
        cx = 0.5 * (x[0] + x[1] - (right - left) * aspect * half), cy = 0.5 * (y[0] + y[1] - (top - bottom) * half);
      }
    }
    half = std::max(half, choice.least_half_height);
    half_height_ = half > 0 ? half : 1.0;
    half_width_ = half_height_ * aspect;
    const double back = points.empty() ? distance : glm::dot(middle, forward_) - extent(points, forward_)[0] + distance;
    eye_ = choice.eye ? *choice.eye : cx * right_ + cy * up_ + (glm::dot(middle, forward_) - back) * forward_;
    return;
  }

  half_height_ = std::tan(0.5 * choice.field_of_view_deg * degree);
  half_width_ = half_height_ * aspect;
  if (choice.eye) {
    eye_ = *choice.eye;
    return;
  }
  if (points.empty()) {
    eye_ = middle - distance * forward_;
    return;
  }
  // In camera axes a point (x, y, z) lies inside the right edge of the pyramid of an eye (u, v, w) if x - u <= t_r (z - w). Over all
  // points: a_r = max(x - t_r z) <= u - t_r w, and a_l = max(-x - t_l z) <= -u - t_l w; so w <= -(a_r + a_l) / (t_r + t_l). The same
  // upwards.
  const double tr = right * half_width_, tl = left * half_width_, tt = top * half_height_, tb = bottom * half_height_;
  double ar = -std::numeric_limits<double>::infinity(), al = ar, at = ar, ab = ar, nearest = -ar;
  for (const auto& p : points) {
    const Vec3 q = p - middle;
    const double x = glm::dot(q, right_), y = glm::dot(q, up_), z = glm::dot(q, forward_);
    ar = std::max(ar, x - tr * z), al = std::max(al, -x - tl * z);
    at = std::max(at, y - tt * z), ab = std::max(ab, -y - tb * z);
    nearest = std::min(nearest, z);
  }
  double u = 0, v = 0, w = std::min(-(ar + al) / (tr + tl), -(at + ab) / (tt + tb));
  if (choice.target) {
    w = std::min({-ar / tr, -al / tl, -at / tt, -ab / tb});
  } else {
    // Slack of the looser axis goes to both of its sides.
    u = 0.5 * ((ar + tr * w) - (al + tl * w)), v = 0.5 * ((at + tt * w) - (ab + tb * w));
  }
  w = std::min(w, nearest - 1e-6 * distance);
  eye_ = middle + u * right_ + v * up_ + w * forward_;
}

CameraRay Camera::ray(double x, double y) const {
  const Vec3 across = (2 * x - 1) * half_width_ * right_ + (1 - 2 * y) * half_height_ * up_;
  if (orthographic_) return {eye_ + across, forward_};
  return {eye_, glm::normalize(forward_ + across)};
}

std::optional<std::array<double, 2>> Camera::project(const Vec3& p) const {
  const Vec3 q = p - eye_;
  double x = glm::dot(q, right_) / half_width_, y = glm::dot(q, up_) / half_height_;
  if (!orthographic_) {
    const double z = glm::dot(q, forward_);
    if (!(z > 0)) return std::nullopt;
    x /= z, y /= z;
  }
  return std::array<double, 2>{0.5 * (1 + x), 0.5 * (1 - y)};
}

}  // namespace sunfleck
