#include <sunfleck/radiosity/lamp_light.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/cosine_direction.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr std::size_t most_candidates = 32;
constexpr double least_image_slope = 1e-3;  // towards images of lamps

/// The part of a triangle on the positive side of the plane through the origin; at most four corners.
int clip(const Triangle& t, const Vec3& n, Vec3* out) {
  const double height[3] = {glm::dot(n, t[0]), glm::dot(n, t[1]), glm::dot(n, t[2])};
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = i == 2 ? 0 : i + 1;
    if (height[i] >= 0.0) out[count++] = t[i];
    if ((height[i] > 0.0 && height[j] < 0.0) || (height[i] < 0.0 && height[j] > 0.0))
      out[count++] = t[i] + height[i] / (height[i] - height[j]) * (t[j] - t[i]);
  }
  return count;
}

}  // namespace

double view_factor(const Vec3& p, const Vec3& n, const Triangle& triangle) {
  Vec3 corner[4];
  const int count = clip({triangle[0] - p, triangle[1] - p, triangle[2] - p}, n, corner);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const Vec3 &a = corner[i], &b = corner[i + 1 == count ? 0 : i + 1], c = glm::cross(a, b);
    const double length = glm::length(c);
    if (length > 0.0) sum += glm::dot(n, c) / length * std::atan2(length, glm::dot(a, b));
  }
  return std::abs(sum) / (2.0 * pi);
}

/// A lamp face or a point of a beam's opening, seen from a point.
struct LampLight::Candidate {
  std::size_t emitter;
  double weight;   ///< 1 / its chance of being looked at
  double view[2];  ///< from front and back: view factor, or intensity x cos / r^2
  Vec3 point;      ///< of a beam's opening
};

LampLight::LampLight(const Scene& scene) : lamps_(place_lamps(scene)), bands_(scene.band_count()), cell_(scene.periodic) {
  std::vector<double> total(bands_, 0.0);
  for (const auto& unit : lamps_.units)
    for (std::size_t b = 0; b < bands_; ++b) total[b] += unit.power[b];
  const auto part = [&](const std::vector<double>& strength) {
    double sum = 0.0;
    for (std::size_t b = 0; b < bands_; ++b) sum += total[b] > 0.0 ? strength[b] / total[b] : 0.0;
    return sum;
  };
  double power = 0.0;
  const auto add = [&](double importance, double share, const Vec3& at) {
    importance_.push_back(importance);
    cumulative_.push_back(power += share);
    centre_ += share * at;
  };
  for (const auto& face : lamps_.faces) {
    const double importance = part(lamps_.units[face.unit].exitance);
    add(importance, importance * face.area, (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0);
  }
  for (const auto& beam : lamps_.beams) {
    const double importance = part(lamps_.units[beam.unit].power);
    add(importance, importance, beam.position);
  }
  if (power > 0.0) centre_ /= power;
}

/// The chance of an image is the view factor, from both sides together, of its cell as a rectangle at the lamps' height: over all images
/// these add up to 1.
LampLight::Image LampLight::draw_image(const Vec3& p, const Vec3& n, double x, double y) const {
  const double width = cell_->width(), depth = cell_->depth(), rise = centre_.z - p.z;
  const double up = rise < 0.0 ? -1.0 : 1.0, height = std::max(std::abs(rise), 0.25 * std::min(width, depth));
  Vec3 d = cosine_direction(n, x, y);
  if (d.z * up < 0.0) d = -d;
  if (std::abs(d.z) < least_image_slope) return {Vec3{0.0}, 0.0};
  const Vec3 at = p + height / std::abs(d.z) * d;
  const double i = std::floor((at.x - cell_->x_low) / width), j = std::floor((at.y - cell_->y_low) / depth);
  const double x0 = cell_->x_low + i * width, y0 = cell_->y_low + j * depth, z = p.z + up * height;
  const Vec3 a{x0, y0, z}, b{x0 + width, y0, z}, c{x0 + width, y0 + depth, z}, e{x0, y0 + depth, z};
  Image image;
  image.chance =
      view_factor(p, n, {a, b, c}) + view_factor(p, n, {a, c, e}) + view_factor(p, -n, {a, b, c}) + view_factor(p, -n, {a, c, e});
  image.shift = {(i - std::floor((centre_.x - cell_->x_low) / width)) * width, (j - std::floor((centre_.y - cell_->y_low) / depth)) * depth,
                 0.0};
  return image;
}

void LampLight::candidates(const Vec3& p, const Vec3& n, double pick, double x, double y, double clearance,
                           std::vector<Candidate>& out) const {
  out.clear();
  const auto look = [&](std::size_t e, double weight) {
    Candidate c{e, weight, {0.0, 0.0}, {}};
    if (e < lamps_.faces.size()) {
      const auto& face = lamps_.faces[e];
      if (!(glm::dot(face.normal, p - face.corners[0]) > clearance)) return;  // nearer: in its plane, as a housing is
      c.view[0] = view_factor(p, n, face.corners);
      c.view[1] = view_factor(p, -n, face.corners);
    } else {
      const auto& beam = lamps_.beams[e - lamps_.faces.size()];
      c.point = beam.point(x, y);
      const Vec3 d = p - c.point;
      const double square = glm::dot(d, d);
      if (!(square > 0.0)) return;
      const Vec3 unit = d / std::sqrt(square);
      const double cosine = -glm::dot(unit, n);
      c.view[cosine > 0.0 ? 0 : 1] = beam.photometry->intensity(beam.to_lamp * unit) * std::abs(cosine) / square;
    }
    if (c.view[0] > 0.0 || c.view[1] > 0.0) out.push_back(c);
  };
  if (importance_.size() <= most_candidates) {
    for (std::size_t e = 0; e < importance_.size(); ++e) look(e, 1.0);
    return;
  }
  for (std::size_t k = 0; k < most_candidates; ++k) {
    const double at = (static_cast<double>(k) + pick) / most_candidates * cumulative_.back();
    const auto e =
        std::min<std::size_t>(static_cast<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin()),
                              cumulative_.size() - 1);
    const double share = cumulative_[e] - (e > 0 ? cumulative_[e - 1] : 0.0);
    look(e, cumulative_.back() / (most_candidates * share));
  }
}

void LampLight::on_patch(const Patch& patch, std::uint32_t start, double lift, std::uint32_t rays, std::uint64_t key,
                         const Surroundings& scene, double share, double* out) const {
  const Vec3 n = patch.normal();
  if (cumulative_.empty() || !(cumulative_.back() > 0.0) || n == Vec3{0.0}) return;
  thread_local std::vector<Candidate> seen;
  thread_local std::vector<double> open, met, lit;  // [set][2][b]: without anything in the way; of the rays; of those that arrive
  open.assign(values(), 0.0);
  met.assign(values(), 0.0);
  lit.assign(values(), 0.0);
  double met_all = 0.0, lit_all = 0.0;
  const auto scramble = static_cast<std::uint32_t>(key);
  const auto strength = [&](std::size_t e) -> const std::vector<double>& {
    return e < lamps_.faces.size() ? lamps_.units[lamps_.faces[e].unit].exitance
                                   : lamps_.units[lamps_.beams[e - lamps_.faces.size()].unit].power;
  };
  const auto unit_of = [&](std::size_t e) {
    return e < lamps_.faces.size() ? lamps_.faces[e].unit : lamps_.beams[e - lamps_.faces.size()].unit;
  };
  const auto add = [&](std::vector<double>& sums, std::size_t e, int side, double factor) {
    const auto& values_of = strength(e);
    for (std::size_t k = 0; k < lamps_.sets.size(); ++k)
      if (lamps_.shines(k, unit_of(e)))
        for (std::size_t b = 0; b < bands_; ++b) sums[(2 * k + static_cast<std::size_t>(side)) * bands_ + b] += factor * values_of[b];
  };
  for (std::uint32_t r = 0; r < rays; ++r) {
    const auto x = [&](unsigned dimension) { return sobol_owen(r, dimension, scramble); };
    const Vec3 p = patch.point(x(0), x(1));
    const Image image = cell_ ? draw_image(p, n, x(5), x(6)) : Image{};
    if (!(image.chance > 0.0)) continue;
    const Vec3 from = p - image.shift;  // the point among the lamps as they are given
    const double u = x(3), v = x(4);
    candidates(from, n, importance_.size() > most_candidates ? x(7) : 0.0, u, v, scene.clearance(), seen);
    double sum = 0.0;
    for (auto& c : seen) {
      c.weight /= image.chance;
      for (int side = 0; side < 2; ++side) {
        if (c.view[side] > 0.0) add(open, c.emitter, side, c.weight * c.view[side]);
        sum += c.weight * importance_[c.emitter] * c.view[side];
      }
    }
    if (!(sum > 0.0)) continue;
    // one of them, and one of the sides, in proportion to what it gives
    const Candidate* chosen = nullptr;
    int side = 0;
    double chance = 0.0, left = x(2) * sum;
    for (const auto& c : seen)
      for (int s = 0; s < 2; ++s) {
        const double given = c.weight * importance_[c.emitter] * c.view[s];
        if (!(given > 0.0) || (chosen && left < 0.0)) continue;
        chosen = &c, side = s, chance = given / sum;
        left -= given;
      }
    Vec3 to;
    double factor = chosen->weight / chance;
    if (chosen->emitter < lamps_.faces.size()) {
      const auto& face = lamps_.faces[chosen->emitter];
      const double root = std::sqrt(u);
      to = face.corners[0] + root * (1.0 - v) * (face.corners[1] - face.corners[0]) + root * v * (face.corners[2] - face.corners[0]) - from;
      const double square = glm::dot(to, to), cosine = (side == 0 ? 1.0 : -1.0) * glm::dot(n, to), there = -glm::dot(face.normal, to);
      if (!(cosine > 0.0 && there > 0.0)) continue;  // below the horizon of this side
      factor *= cosine * there * face.area / (pi * square * square);
    } else {
      to = chosen->point - from;
      factor *= chosen->view[side];
    }
    const double distance = glm::length(to);
    const Vec3 direction = to / distance, origin = p + (side == 0 ? lift : -lift) * n;
    const bool arrives = distance <= scene.clearance() || !scene.blocked(origin, direction, start, distance - scene.clearance());
    add(met, chosen->emitter, side, factor);
    met_all += factor * importance_[chosen->emitter];
    if (!arrives) continue;
    add(lit, chosen->emitter, side, factor);
    lit_all += factor * importance_[chosen->emitter];
  }
  // what no ray went to is seen as the rest is
  const double rest = met_all > 0.0 ? lit_all / met_all : 0.0;
  for (std::size_t i = 0; i < open.size(); ++i) out[i] += share / rays * open[i] * (met[i] > 0.0 ? lit[i] / met[i] : rest);
}

}  // namespace sunfleck
