#include "original/path_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr double roulette_below = 0.1;  ///< weights under this share of the first go on by chance
using std::numbers::pi;

/// Direction with density cos / pi about a unit normal.
Vec3 cosine_direction(const Vec3& normal, double a, double b) {
  Vec3 u, v;
  orthonormal_frame(normal, u, v);
  const double r = std::sqrt(a), phi = 2.0 * pi * b;
  return glm::normalize(r * std::cos(phi) * u + r * std::sin(phi) * v + std::sqrt(std::max(0.0, 1.0 - a)) * normal);
}

}  // namespace

/// One side of a facet at a point: rays that left it.
struct PathMeasurement::Side {
  std::array<double, harmonic_count(highest_order)> y{};  ///< V in harmonics; to highest_order at first vertices, else to the basis' order
  Values v{};                                             ///< V in the basis
  std::array<RayHit, most_rays> blocked;
  int blocked_count = 0, count = 0;
};

PathMeasurement::PathMeasurement(const OriginalGeometry& geometry, MeasureBasis basis) : geometry_(&geometry), basis_(std::move(basis)) {
  const std::size_t n = geometry.corners.size();
  scene_.corners = geometry.corners;
  scene_.plant_facets = n;
  scene_.bands = geometry.bands;
  cumulative_.push_back(0.0);
  for (const auto& c : geometry.corners) {
    const Vec3 vector = area_vector(c);
    const double area = glm::length(vector);
    scene_.area.push_back(static_cast<float>(area));
    const bool solid = scene_.area.back() > 0.0f;
    if (solid)
      for (const auto& p : c) scene_.bounds.add(p);
    normals_.push_back(solid ? vector / area : Vec3{0, 0, 1});
    cumulative_.push_back(cumulative_.back() + (solid ? area : 0.0));
  }
  area_ = cumulative_.back();
  if (!(area_ > 0)) throw InputError("original", std::to_string(n) + " facets without area", "at least one facet with an area");
  for (const auto& m : geometry.materials)
    materials_.push_back(
        {{{m.reflectance_front.begin(), m.reflectance_front.end()}, {m.reflectance_back.begin(), m.reflectance_back.end()}},
         {m.transmittance.begin(), m.transmittance.end()}});
  rays_ = std::make_unique<RayScene>(scene_);
}

PathSums PathMeasurement::no_sums() const {
  PathSums s;
  const std::size_t n = basis_.size();
  s.sigma.assign(harmonic_count(highest_order), 0.0);
  s.intercepted.assign(n, 0.0);
  s.absorbed.assign(geometry_->bands * n, 0.0);
  s.phase.assign(geometry_->bands * n * n, 0.0);
  return s;
}

void PathMeasurement::add(PathSums& sums, std::uint32_t first, std::uint32_t count, std::uint64_t seed, const Progress& progress) const {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % 256 == 0) progress.check();
    one(sums, first + i, seed);
  }
  sums.samples += count;
}

void PathMeasurement::gather(std::uint32_t facet, const Vec3& point, const Vec3& normal, double shift_x, double shift_y, int count,
                             bool first, Side& side, std::uint64_t& rays) const {
  std::array<double, harmonic_count(highest_order)> y;
  const std::size_t order = first ? highest_order : basis_.order, n = first || basis_.harmonic() ? harmonic_count(order) : 0;
  side.count = count;
  for (int k = 0; k < count; ++k) {
    const auto [a, b] = r2_point(static_cast<std::uint64_t>(k), shift_x, shift_y);
    const Vec3 d = cosine_direction(normal, a, b);
    if (const RayHit hit = rays_->first_hit(point, d, facet)) {
      side.blocked[static_cast<std::size_t>(side.blocked_count++)] = hit;
    } else if (n > 0) {
      harmonics(d, order, y.data());
      for (std::size_t i = 0; i < n; ++i) side.y[i] += y[i];
    }
  }
  rays += static_cast<std::uint64_t>(count);
  for (std::size_t i = 0; i < n; ++i) side.y[i] *= pi / count;
  if (basis_.harmonic()) std::copy_n(side.y.begin(), basis_.size(), side.v.begin());
}

void PathMeasurement::fixed(std::uint32_t facet, const Vec3& point, const Vec3& normal, Side& front, Side& back,
                            std::uint64_t& rays) const {
  for (std::size_t k = 0; k < basis_.directions.size(); ++k) {
    const double cosine = glm::dot(normal, basis_.directions[k]);
    const bool free = cosine != 0.0 && !rays_->occluded(point, basis_.directions[k], facet);
    front.v[k] = free ? std::max(cosine, 0.0) : 0.0;
    back.v[k] = free ? std::max(-cosine, 0.0) : 0.0;
  }
  rays += basis_.directions.size();
}

void PathMeasurement::one(PathSums& sums, std::uint32_t n, std::uint64_t seed) const {
  const std::size_t size = basis_.size(), bands = geometry_->bands;
  const auto low = static_cast<std::uint32_t>(seed);
  RandomStream random(mix(seed, n));

  const double at = sobol_owen(n, 0, low) * area_;
  const auto facet = static_cast<std::uint32_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), at) - cumulative_.begin() - 1, 0,
                                 static_cast<std::ptrdiff_t>(scene_.size()) - 1));
  const double root = std::sqrt(sobol_owen(n, 1, low)), along = sobol_owen(n, 2, low);
  const Triangle& c = scene_.corners[facet];
  const Vec3 point = c[0] + root * (1.0 - along) * (c[1] - c[0]) + root * along * (c[2] - c[0]);
  const Vec3& normal = normals_[facet];
  const Material& m = materials_[geometry_->optics[facet]];

  // Sets a and b are independent of each other, and so are the shifts of a's front and b's back.
  Side front_a, back_a, front_b, back_b;
  const double ax = sobol_owen(n, 3, low), ay = sobol_owen(n, 4, low), bx = sobol_owen(n, 5, low), by = sobol_owen(n, 6, low);
  gather(facet, point, normal, ax, ay, most_rays, true, front_a, sums.rays);
  gather(facet, point, -normal, ax, ay, most_rays, true, back_a, sums.rays);
  if (basis_.harmonic()) {
    gather(facet, point, normal, bx, by, most_rays, true, front_b, sums.rays);
    gather(facet, point, -normal, bx, by, most_rays, true, back_b, sums.rays);
    for (std::size_t i = 0; i < front_a.y.size(); ++i) sums.sigma[i] += 0.5 * (front_a.y[i] + front_b.y[i] + back_a.y[i] + back_b.y[i]);
  } else {
    fixed(facet, point, normal, front_a, back_a, sums.rays);
    front_b.v = front_a.v;
    back_b.v = back_a.v;
    for (std::size_t i = 0; i < front_a.y.size(); ++i) sums.sigma[i] += front_a.y[i] + back_a.y[i];
  }

  // Radiosity of both sides, per band, from set b; the first scattering pairs it with set a.
  const int choices = front_a.blocked_count + back_a.blocked_count;
  const int chosen = choices > 0 ? std::min(static_cast<int>(random.next() * choices), choices - 1) : -1;
  const bool from_front = chosen < front_a.blocked_count;
  std::vector<Values> emitted(chosen >= 0 ? bands : 0);  // by the side from which the path goes on
  Values v_front, v_back;
  for (std::size_t i = 0; i < size; ++i) {
    v_front[i] = 0.5 * (front_a.v[i] + front_b.v[i]);
    v_back[i] = 0.5 * (back_a.v[i] + back_b.v[i]);
    sums.intercepted[i] += v_front[i] + v_back[i];
  }
  for (std::size_t b = 0; b < bands; ++b) {
    const double rf = m.reflectance[0][b], rb = m.reflectance[1][b], t = m.transmittance[b];
    Values of_front, of_back;
    for (std::size_t i = 0; i < size; ++i) {
      of_front[i] = rf * front_b.v[i] + t * back_b.v[i];
      of_back[i] = rb * back_b.v[i] + t * front_b.v[i];
      sums.absorbed[b * size + i] += (1.0 - rf - t) * v_front[i] + (1.0 - rb - t) * v_back[i];
    }
    double* s = sums.phase.data() + b * size * size;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) s[i * size + j] += front_a.v[i] * of_front[j] + back_a.v[i] * of_back[j];
    if (chosen >= 0) emitted[b] = from_front ? of_front : of_back;
  }
  if (chosen < 0) return;

  RayHit hit = from_front ? front_a.blocked[static_cast<std::size_t>(chosen)]
                          : back_a.blocked[static_cast<std::size_t>(chosen - front_a.blocked_count)];
  const double first_weight = static_cast<double>(choices) / most_rays;
  std::vector<double> weight(bands, 1.0), kept(bands, 0.0);
  std::vector<Values> left(bands, Values{});  // sum over vertices of weight times (reflectance V + transmittance V of the other side)
  for (;;) {
    const Triangle& k = scene_.corners[hit.facet];
    const Vec3 y = k[0] + hit.u * (k[1] - k[0]) + hit.v * (k[2] - k[0]);
    const Material& at_y = materials_[geometry_->optics[hit.facet]];
    const auto& reflectance = at_y.reflectance[hit.front ? 0 : 1];
    const Vec3 lit = hit.front ? normals_[hit.facet] : -normals_[hit.facet];
    Side same, other;
    const int count = basis_.harmonic() ? most_rays : 1;
    const double x = random.next(), z = random.next(), x2 = random.next(), z2 = random.next();
    gather(hit.facet, y, lit, x, z, count, false, same, sums.rays);
    gather(hit.facet, y, -lit, x2, z2, count, false, other, sums.rays);
    if (!basis_.harmonic()) fixed(hit.facet, y, lit, same, other, sums.rays);
    double most_reflected = 0, most_transmitted = 0;
    for (std::size_t b = 0; b < bands; ++b) {
      const double r = weight[b] * reflectance[b], t = weight[b] * at_y.transmittance[b];
      kept[b] += weight[b] - r - t;
      most_reflected = std::max(most_reflected, r);
      most_transmitted = std::max(most_transmitted, t);
      for (std::size_t j = 0; j < size; ++j) left[b][j] += r * same.v[j] + t * other.v[j];
    }
    const double reflected = same.blocked_count * most_reflected, transmitted = other.blocked_count * most_transmitted;
    if (!(reflected + transmitted > 0)) break;
    const double share = reflected / (reflected + transmitted);
    const bool reflects = random.next() < share;
    const Side& side = reflects ? same : other;
    double factor = static_cast<double>(side.blocked_count) / count / (reflects ? share : 1.0 - share);
    const auto ray = std::min(static_cast<int>(random.next() * side.blocked_count), side.blocked_count - 1);
    hit = side.blocked[static_cast<std::size_t>(ray)];
    double most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, weight[b] * factor * (reflects ? reflectance[b] : at_y.transmittance[b]));
    if (most < roulette_below) {
      const double survival = most / roulette_below;
      if (!(random.next() < survival)) break;
      factor /= survival;
    }
    for (std::size_t b = 0; b < bands; ++b) weight[b] *= factor * (reflects ? reflectance[b] : at_y.transmittance[b]);
  }
  for (std::size_t b = 0; b < bands; ++b) {
    double* s = sums.phase.data() + b * size * size;
    for (std::size_t i = 0; i < size; ++i) {
      const double e = first_weight * emitted[b][i];
      sums.absorbed[b * size + i] += e * kept[b];
      for (std::size_t j = 0; j < size; ++j) s[i * size + j] += e * left[b][j];
    }
  }
}

}  // namespace sunfleck
