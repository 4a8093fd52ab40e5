#include <sunfleck/reference/path_sampler.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <sunfleck/core/cosine_direction.hpp>
#include <sunfleck/core/sampling.hpp>

#include "lamp_paths.hpp"

namespace sunfleck {

namespace {

using std::numbers::pi;

/// Above the rounding of rays.
double clearance_of(const RayScene& rays) {
  const Vec3 size = rays.bounds().size();
  double largest = std::max({size.x, size.y, size.z});
  if (const auto& cell = rays.periodic()) largest = std::max({largest, cell->width(), cell->depth()});
  return 4e-6 * largest;
}

}  // namespace

SampleTarget::SampleTarget(const RayScene& rays, std::vector<CopyFacet> facets, std::uint64_t key) : key_(key) {
  double total = 0.0;
  for (const auto f : facets) {
    const auto area = static_cast<float>(glm::length(area_vector(rays.corners(f))));
    if (!(area > 0.0f)) continue;
    facets_.push_back(f);
    cumulative_.push_back(total += area);
  }
}

CopyFacet SampleTarget::facet_at(double x, double& within) const {
  if (facets_.size() == 1) return within = x, facets_[0];
  const double a = x * area();
  const auto i =
      std::min<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), a) - cumulative_.begin(), facets_.size() - 1);
  const double low = i == 0 ? 0.0 : cumulative_[i - 1];
  within = std::clamp((a - low) / (cumulative_[i] - low), 0.0, 1.0);
  return facets_[i];
}

namespace {

/// The facet's plane, looked up once for all that happens at a point of it.
struct FacetPlane {
  explicit FacetPlane(const Triangle& t) : corners(t), normal(glm::normalize(area_vector(t))) {}
  Vec3 point(double u, double v) const { return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]); }
  Triangle corners;
  Vec3 normal;
};

}  // namespace

struct PathSampler::Impl {
  Impl(const Scene& scene, const RayScene& r, std::uint64_t s);

  /// The sun of a state, ready to be sampled.
  struct Beam {
    const Sun* sun = nullptr;
    Vec3 across{0.0}, along{0.0};
    double cos_radius = 1.0;  ///< of the disc
    Vec3 direction(double u, double v) const;
  };

  FacetPlane plane(CopyFacet facet) const { return FacetPlane(rays.met_corners(facet)); }
  std::size_t material(CopyFacet facet) const { return rays.material(facet) * bands; }

  /// Calls hit(state, on_front, irradiance factor: cosine to the sun, 0 < factor) for each state whose sun reaches the point.
  template <class Hit>
  void sun_at(const Vec3& p, CopyFacet facet, const Vec3& n, double u, double v, std::uint64_t& count, Hit&& hit) const;

  /// The same for one point of a lamp: hit(state, on_front, factor, strength [b]) for each state in which that lamp shines, if it reaches
  /// the point. `lift`: how far above the side the ray starts.
  template <class Hit>
  void lamps_at(const Vec3& p, CopyFacet facet, const Vec3& n, double lift, const double* x, std::uint64_t& count, Hit&& hit) const;

  /// Follows a ray through the scene. way(bounce, point, normal there, direction, distance) for every piece of the path, the last one
  /// infinite; hit(bounce, facet, point, normal, front) at every facet met, before it scatters; exit(bounce, direction) if it leaves.
  /// `weight` [b] begins at 1. `n`: the normal where it starts.
  template <class Way, class Hit, class Exit>
  void walk(Vec3 p, Vec3 n, Vec3 d, CopyFacet facet, double* weight, RandomStream& random, std::uint64_t& count, Way&& way, Hit&& hit,
            Exit&& exit) const;

  void one_side(const Vec3& p, const Vec3& n, const Vec3& d, CopyFacet facet, RandomStream& random, double* weight, double* sum,
                double* direct, std::uint64_t& count) const;

  double absorptance(CopyFacet facet, bool on_front, std::size_t b) const {
    const auto m = material(facet) + b;
    return std::max(0.0, 1.0 - (on_front ? front : back)[m] - through[m]);
  }
  /// Light by paths, which leave out the sun on the start itself; and that sun. Both add to sums over `count` samples.
  void add_paths(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, SampleMeans& sums) const;
  void add_sun(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, double share, SampleMeans& sums) const;
  void add_lamps(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, double share, SampleMeans& sums) const;

  struct Particles {
    std::vector<double> in, out;  ///< [s][b]
    std::uint64_t rays = 0;
  };
  Particles particles(std::uint32_t batch, std::uint32_t count) const;

  const RayScene& rays;
  std::uint64_t seed;
  double clearance;  ///< of points on lamps from what stands there [m]
  std::size_t states, bands;
  bool has_sun = false;
  std::unique_ptr<const LampPaths> lamps;    ///< null = none
  std::vector<Beam> beams;                   ///< [s]
  std::vector<const Sky*> skies;             ///< [s], null = none
  std::vector<double> front, back, through;  ///< [material][b]
};

PathSampler::Impl::Impl(const Scene& scene, const RayScene& r, std::uint64_t s)
    : rays(r), seed(s), clearance(clearance_of(r)), states(scene.states.size()), bands(scene.band_count()) {
  for (const auto& state : scene.states) {
    Beam beam;
    if (state.sun) {
      has_sun = true;
      beam.sun = &*state.sun;
      beam.cos_radius = std::cos(0.5 * state.sun->angular_diameter_deg * pi / 180.0);
      orthonormal_frame(state.sun->direction, beam.across, beam.along);
    }
    beams.push_back(beam);
    skies.push_back(state.sky ? &*state.sky : nullptr);
  }
  if (!scene.lamps.empty()) lamps = std::make_unique<const LampPaths>(scene, clearance);
  for (const auto& m : rays.materials())
    for (std::size_t b = 0; b < bands; ++b) {
      front.push_back(m.reflectance_front[b]);
      back.push_back(m.reflectance_back[b]);
      through.push_back(m.transmittance[b]);
    }
}

/// Uniform over the disc's solid angle.
Vec3 PathSampler::Impl::Beam::direction(double u, double v) const {
  if (cos_radius >= 1.0) return sun->direction;
  const double c = 1.0 - u * (1.0 - cos_radius), s = std::sqrt(std::max(0.0, 1.0 - c * c)), azimuth = 2.0 * pi * v;
  return glm::normalize(s * std::cos(azimuth) * across + s * std::sin(azimuth) * along + c * sun->direction);
}

template <class Hit>
void PathSampler::Impl::sun_at(const Vec3& p, CopyFacet facet, const Vec3& n, double u, double v, std::uint64_t& count, Hit&& hit) const {
  for (std::size_t s = 0; s < states; ++s) {
    const Beam& beam = beams[s];
    if (!beam.sun) continue;
    const Vec3 d = beam.direction(u, v);
    const double c = glm::dot(d, n);
    if (c == 0.0 || (rays.periodic() && rays.periodic()->above(d) <= 0.0)) continue;  // a scene without end hides what is below its horizon
    ++count;
    // The sun's irradiance is on a plane that faces its centre: the disc's mean cosine there is (1 + cos radius) / 2.
    if (!rays.occluded(p, d, facet)) hit(s, c > 0.0, std::abs(c) * 2.0 / (1.0 + beam.cos_radius));
  }
}

template <class Hit>
void PathSampler::Impl::lamps_at(const Vec3& p, CopyFacet facet, const Vec3& n, double lift, const double* x, std::uint64_t& count,
                                 Hit&& hit) const {
  const auto draw = lamps->draw(p, n, x);
  if (!(draw.factor > 0.0)) return;
  ++count;
  const double range = draw.distance - clearance;
  if (range > 0.0 && rays.occluded(p + (draw.on_front ? lift : -lift) * n, draw.direction, facet, range)) return;
  const auto& placed = lamps->lamps();
  for (std::size_t s = 0; s < states; ++s)
    if (const auto set = placed.set_of_state[s]; set != Lamps::none && placed.shines(set, draw.unit))
      hit(s, draw.on_front, draw.factor, lamps->strength(draw.unit));
}

template <class Way, class Hit, class Exit>
void PathSampler::Impl::walk(Vec3 p, Vec3 n, Vec3 d, CopyFacet facet, double* weight, RandomStream& random, std::uint64_t& count, Way&& way,
                             Hit&& hit, Exit&& exit) const {
  for (int bounce = 0;; ++bounce) {
    ++count;
    const RayHit met = rays.first_hit(p, d, facet);
    way(bounce, p, n, d, met.distance);
    if (!met) return exit(bounce, d);
    facet = met.where();
    const FacetPlane here = plane(facet);
    p = here.point(met.u, met.v);
    n = here.normal;
    hit(bounce, facet, p, n, met.front);

    const auto m = material(facet);
    const double *reflected = (met.front ? front.data() : back.data()) + m, *transmitted = through.data() + m;
    double carried_back = 0.0, carried_on = 0.0, top = 0.0;
    for (std::size_t b = 0; b < bands; ++b) carried_back += weight[b] * reflected[b], carried_on += weight[b] * transmitted[b];
    const double carried = carried_back + carried_on;
    if (!(carried > 0.0)) return;
    const bool reflects = random.next() * carried < carried_back;
    const double probability = (reflects ? carried_back : carried_on) / carried;
    for (std::size_t b = 0; b < bands; ++b) top = std::max(top, weight[b] *= (reflects ? reflected : transmitted)[b] / probability);
    double survival = std::min(1.0, 2.0 * top);
    if (bounce >= 500) survival *= 0.9;  // or a path in a closed white box would never end
    if (survival < 1.0) {
      if (random.next() >= survival) return;
      for (std::size_t b = 0; b < bands; ++b) weight[b] /= survival;
    }
    if (met.front != reflects) n = -n;  // leaves by the front if it came there and is reflected, or came to the back and goes through
    const double u = random.next(), v = random.next();
    d = cosine_direction(n, u, v);
  }
}

void PathSampler::Impl::one_side(const Vec3& start, const Vec3& start_normal, const Vec3& direction, CopyFacet facet, RandomStream& random,
                                 double* weight, double* sum, double* direct, std::uint64_t& count) const {
  std::fill_n(weight, bands, 1.0);
  walk(
      start, start_normal, direction, facet, weight, random, count,
      [&](int bounce, const Vec3& p, const Vec3& n, const Vec3& d, double distance) {
        if (!lamps) return;
        lamps->cross(p, n, d, distance + clearance, count, [&](std::uint32_t unit, double part) {
          const auto& placed = lamps->lamps();
          const auto& strength = lamps->strength(unit);
          for (std::size_t s = 0; s < states; ++s) {
            if (const auto set = placed.set_of_state[s]; set == Lamps::none || !placed.shines(set, unit)) continue;
            for (std::size_t b = 0; b < bands; ++b) {
              const double light = weight[b] * part * strength[b];
              sum[2 * s * bands + b] += light;
              if (bounce == 0) direct[2 * s * bands + b] += light;
            }
          }
        });
      },
      [&](int, CopyFacet f, const Vec3& p, const Vec3& n, bool on_front) {
        const auto m = material(f);
        if (lamps) {
          double x[5];
          for (auto& value : x) value = random.next();
          lamps_at(p, f, n, 0.0, x, count, [&](std::size_t s, bool lamp_on_front, double factor, const std::vector<double>& strength) {
            const double* scatter = (lamp_on_front != on_front ? through.data() : on_front ? front.data() : back.data()) + m;
            for (std::size_t b = 0; b < bands; ++b) sum[2 * s * bands + b] += weight[b] * scatter[b] * factor * strength[b];
          });
        }
        if (!has_sun) return;
        const double u = random.next(), v = random.next();
        sun_at(p, f, n, u, v, count, [&](std::size_t s, bool sun_on_front, double factor) {
          const double* scatter = (sun_on_front != on_front ? through.data() : on_front ? front.data() : back.data()) + m;
          for (std::size_t b = 0; b < bands; ++b) sum[2 * s * bands + b] += weight[b] * scatter[b] * factor * beams[s].sun->irradiance[b];
        });
      },
      [&](int bounce, const Vec3& d) {
        for (std::size_t s = 0; s < states; ++s) {
          if (!skies[s]) continue;
          const double radiance = pi * skies[s]->relative_radiance(d);
          for (std::size_t b = 0; b < bands; ++b) {
            const double light = weight[b] * radiance * skies[s]->irradiance[b];
            sum[2 * s * bands + b] += light;
            if (bounce == 0) direct[2 * s * bands + b] += light;
          }
        }
      });
}

PathSampler::PathSampler(const Scene& scene, const RayScene& rays, std::uint64_t seed)
    : impl_(std::make_unique<const Impl>(scene, rays, seed)) {}
PathSampler::~PathSampler() = default;
std::size_t PathSampler::states() const {
  return impl_->states;
}
std::size_t PathSampler::bands() const {
  return impl_->bands;
}
bool PathSampler::has_sun() const {
  return impl_->has_sun;
}

void PathSampler::Impl::add_paths(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, SampleMeans& sums) const {
  std::vector<double> here(states * 2 * bands), weight(bands);
  const auto scramble = static_cast<std::uint32_t>(stream);
  for (std::uint32_t i = 0; i < count; ++i) {
    double x;
    const CopyFacet facet = target.facet_at(sobol_owen(i, 0, scramble), x);
    const double root = std::sqrt(x), y = sobol_owen(i, 1, scramble);
    const FacetPlane start = plane(facet);
    const Vec3 p = start.point(root * (1.0 - y), root * y), n = start.normal;
    RandomStream random(mix(stream, i));
    std::fill(here.begin(), here.end(), 0.0);
    one_side(p, n, cosine_direction(n, sobol_owen(i, 2, scramble), sobol_owen(i, 3, scramble)), facet, random, weight.data(), here.data(),
             sums.direct.data(), sums.rays);
    one_side(p, n, cosine_direction(-n, sobol_owen(i, 4, scramble), sobol_owen(i, 5, scramble)), facet, random, weight.data(),
             here.data() + bands, sums.direct.data() + bands, sums.rays);
    for (std::size_t k = 0; k < here.size(); ++k) {
      sums.irradiance[k] += here[k];
      sums.absorbed[k / (2 * bands) * bands + k % bands] += absorptance(facet, k / bands % 2 == 0, k % bands) * here[k];
    }
  }
}

void PathSampler::Impl::add_sun(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, double share,
                                SampleMeans& sums) const {
  const auto scramble = static_cast<std::uint32_t>(mix(stream, 0x73756eULL));
  for (std::uint32_t i = 0; i < count; ++i) {
    double x;
    const CopyFacet facet = target.facet_at(sobol_owen(i, 0, scramble), x);
    const double root = std::sqrt(x), y = sobol_owen(i, 1, scramble);
    const FacetPlane start = plane(facet);
    sun_at(start.point(root * (1.0 - y), root * y), facet, start.normal, sobol_owen(i, 2, scramble), sobol_owen(i, 3, scramble), sums.rays,
           [&](std::size_t s, bool on_front, double factor) {
             const std::size_t side = 2 * s + (on_front ? 0 : 1);
             sums.sunlit[side] += share;
             for (std::size_t b = 0; b < bands; ++b) {
               const double light = share * factor * beams[s].sun->irradiance[b];
               sums.irradiance[side * bands + b] += light;
               sums.direct[side * bands + b] += light;
               sums.absorbed[s * bands + b] += absorptance(facet, on_front, b) * light;
             }
           });
  }
}

/// Points and lamps from one sequence: coordinates of equal dimension from two scrambles of it would go together.
void PathSampler::Impl::add_lamps(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, double share,
                                  SampleMeans& sums) const {
  const auto scramble = static_cast<std::uint32_t>(mix(stream, 0x6c616d70ULL));
  for (std::uint32_t i = 0; i < count; ++i) {
    double x, numbers[5];
    const CopyFacet facet = target.facet_at(sobol_owen(i, 0, scramble), x);
    const double root = std::sqrt(x), y = sobol_owen(i, 1, scramble);
    for (unsigned k = 0; k < 5; ++k) numbers[k] = sobol_owen(i, 2 + k, scramble);
    const FacetPlane start = plane(facet);
    lamps_at(start.point(root * (1.0 - y), root * y), facet, start.normal, 0.0, numbers, sums.rays,
             [&](std::size_t s, bool on_front, double factor, const std::vector<double>& strength) {
               const std::size_t side = 2 * s + (on_front ? 0 : 1);
               for (std::size_t b = 0; b < bands; ++b) {
                 const double light = share * factor * strength[b];
                 sums.irradiance[side * bands + b] += light;
                 sums.direct[side * bands + b] += light;
                 sums.absorbed[s * bands + b] += absorptance(facet, on_front, b) * light;
               }
             });
  }
}

void PathSampler::sample(const SampleTarget& target, std::uint32_t randomisation, std::uint32_t count, std::uint32_t sun_points,
                         SampleMeans& means) const {
  const Impl& my = *impl_;
  means.irradiance.assign(my.states * 2 * my.bands, 0.0);
  means.direct.assign(my.states * 2 * my.bands, 0.0);
  means.absorbed.assign(my.states * my.bands, 0.0);
  means.sunlit.assign(my.states * 2, 0.0);
  means.rays = 0;
  if (!(target.area() > 0.0) || count == 0) return;
  const std::uint64_t stream = mix(my.seed, target.key(), randomisation);
  my.add_paths(target, stream, count, means);
  if (my.lamps) my.add_lamps(target, stream, count * sun_points, 1.0 / sun_points, means);
  if (my.has_sun) my.add_sun(target, stream, count * sun_points, 1.0 / sun_points, means);
  for (auto* sums : {&means.irradiance, &means.direct, &means.absorbed, &means.sunlit})
    for (auto& value : *sums) value /= count;
}

void PathSampler::sample_patch(const Patch& patch, bool both, double lift, std::uint64_t key, std::uint32_t count, double* sums,
                               std::uint64_t& rays) const {
  const Impl& my = *impl_;
  const Vec3 n = patch.normal();
  if (n == Vec3{0.0}) return;
  const std::size_t bands = my.bands, sides = both ? 2 : 1;
  const std::uint64_t stream = mix(my.seed, 0x7061746368ULL, key);
  const auto scramble = static_cast<std::uint32_t>(stream), lights = static_cast<std::uint32_t>(mix(stream, 1));
  std::vector<double> here(my.states * 2 * bands), ignored(my.states * 2 * bands), weight(bands);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::fill(here.begin(), here.end(), 0.0);
    const Vec3 p = patch.point(sobol_owen(i, 0, scramble), sobol_owen(i, 1, scramble));
    RandomStream random(mix(stream, i));
    for (std::size_t side = 0; side < sides; ++side) {
      const Vec3 up = side == 0 ? n : -n, from = p + lift * up;
      const auto dimension = static_cast<unsigned>(2 + 2 * side);
      const Vec3 d = cosine_direction(up, sobol_owen(i, dimension, scramble), sobol_owen(i, dimension + 1, scramble));
      my.one_side(from, up, d, nowhere, random, weight.data(), here.data() + side * bands, ignored.data(), rays);
      if (my.has_sun)
        my.sun_at(from, nowhere, up, sobol_owen(i, 6, scramble), sobol_owen(i, 7, scramble), rays,
                  [&](std::size_t s, bool on_side, double factor) {
                    if (on_side)
                      for (std::size_t b = 0; b < bands; ++b) here[(2 * s + side) * bands + b] += factor * my.beams[s].sun->irradiance[b];
                  });
    }
    if (my.lamps) {
      const Vec3 at = patch.point(sobol_owen(i, 0, lights), sobol_owen(i, 1, lights));
      double x[5];
      for (unsigned k = 0; k < 5; ++k) x[k] = sobol_owen(i, 2 + k, lights);
      my.lamps_at(at, nowhere, n, lift, x, rays, [&](std::size_t s, bool on_front, double factor, const std::vector<double>& strength) {
        for (std::size_t b = 0; b < bands; ++b) here[(2 * s + (on_front ? 0 : 1)) * bands + b] += factor * strength[b];
      });
    }
    for (std::size_t s = 0; s < my.states; ++s)
      for (std::size_t side = 0; side < sides; ++side)
        for (std::size_t b = 0; b < bands; ++b) sums[(side * my.states + s) * bands + b] += here[(2 * s + side) * bands + b] / count;
  }
}

PathSampler::Impl::Particles PathSampler::Impl::particles(std::uint32_t batch, std::uint32_t count) const {
  Particles sum{std::vector<double>(states * bands, 0.0), std::vector<double>(states * bands, 0.0), 0};
  if (rays.bounds().empty()) return sum;
  const Vec3 centre = rays.bounds().centre();
  const double radius = 0.5 * glm::length(rays.bounds().size());
  double heights[2] = {rays.bounds().low.z, rays.bounds().high.z};  // above the plane of a periodic scene
  if (rays.periodic() && !rays.periodic()->is_level()) {
    Box levelled;
    for (int i = 0; i < 8; ++i) {
      const auto &low = rays.bounds().low, &high = rays.bounds().high;
      levelled.add(rays.periodic()->levelled({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}));
    }
    heights[0] = levelled.low.z, heights[1] = levelled.high.z;
  }
  std::vector<double> weight(bands);
  std::optional<LampEmission> emission;
  if (lamps) emission.emplace(lamps->lamps());
  // Follows a particle that stands for factor x power[b].
  const auto follow = [&](std::size_t s, const Vec3& from, const Vec3& d, double factor, const std::vector<double>& power,
                          RandomStream& random) {
    std::fill(weight.begin(), weight.end(), 1.0);
    walk(
        from, d, d, nowhere, weight.data(), random, sum.rays, [](int, const Vec3&, const Vec3&, const Vec3&, double) {},
        [&](int bounce, CopyFacet, const Vec3&, const Vec3&, bool) {
          if (bounce == 0)
            for (std::size_t b = 0; b < bands; ++b) sum.in[s * bands + b] += factor * power[b];
        },
        [&](int bounce, const Vec3&) {
          if (bounce > 0)
            for (std::size_t b = 0; b < bands; ++b) sum.out[s * bands + b] += factor * power[b] * weight[b];
        });
  };
  // Sends one particle that stands for irradiance[b] along the line that comes from direction d, through the point u, v of a disc that
  // holds the scene's shadow, or of the cell's top or bottom.
  const auto send = [&](std::size_t s, const Vec3& d, double u, double v, double factor, const std::vector<double>& irradiance,
                        RandomStream& random) {
    Vec3 from;
    if (rays.periodic()) {
      const auto& cell = *rays.periodic();
      const double margin = 1e-3 * (rays.bounds().size().z + cell.width()), gain = cell.above(d);
      from = {cell.x_low + u * cell.width(), cell.y_low + v * cell.depth(), 0.0};
      from.z = (gain > 0.0 ? heights[1] + margin : heights[0] - margin) - cell.above(from);
      factor *= cell.area() * std::abs(gain);
    } else {
      Vec3 a, b;
      orthonormal_frame(d, a, b);
      const double r = radius * std::sqrt(u);
      from = centre + 2.0 * radius * d + r * std::cos(2.0 * pi * v) * a + r * std::sin(2.0 * pi * v) * b;
      factor *= pi * radius * radius;
    }
    follow(s, from, -d, factor, irradiance, random);
  };
  for (std::size_t s = 0; s < states; ++s) {
    const std::uint64_t stream = mix(seed ^ 0x65736361ULL, s, batch);
    const auto scramble = static_cast<std::uint32_t>(stream);
    for (std::uint32_t i = 0; i < count; ++i) {
      RandomStream random(mix(stream, i));
      const auto x = [&](unsigned dimension) { return sobol_owen(i, dimension, scramble); };
      if (const auto& beam = beams[s]; beam.sun) {
        const Vec3 d = beam.direction(x(2), x(3));
        if (!rays.periodic() || rays.periodic()->above(d) > 0.0) send(s, d, x(0), x(1), 1.0, beam.sun->irradiance, random);
      }
      if (const Sky* sky = skies[s]) {
        // Uniform over the upper hemisphere, or over the sphere if light comes from there.
        const bool all_round = sky->reaches_below_horizon();
        const double z = all_round ? 2.0 * x(6) - 1.0 : x(6), r = std::sqrt(1.0 - z * z), azimuth = 2.0 * pi * x(7);
        const Vec3 d{r * std::cos(azimuth), r * std::sin(azimuth), z};
        send(s, d, x(4), x(5), (all_round ? 4.0 : 2.0) * pi * sky->relative_radiance(d), sky->irradiance, random);
      }
      if (emission && emission->power() > 0.0 && lamps->lamps().set_of_state[s] != Lamps::none) {
        double numbers[5];
        for (unsigned k = 0; k < 5; ++k) numbers[k] = sobol_owen(i, k, scramble ^ 0x6c616d70u);
        const auto particle = emission->draw(numbers);
        if (lamps->lamps().shines(lamps->lamps().set_of_state[s], particle.unit))
          follow(s, particle.from + clearance * particle.direction, particle.direction, particle.weight,
                 lamps->lamps().units[particle.unit].power, random);
      }
    }
  }
  return sum;
}

PathSampler::Escape PathSampler::escape_share(std::uint32_t count) const {
  constexpr std::uint32_t batches = 16;
  const std::size_t size = impl_->states * impl_->bands;
  std::vector<Impl::Particles> parts(batches);
  tbb::parallel_for(std::uint32_t{0}, batches, [&](std::uint32_t k) { parts[k] = impl_->particles(k, count); });
  Escape escape{std::vector<double>(size, 0.0), std::vector<double>(size, 0.0), 0};
  for (const auto& part : parts) escape.rays += part.rays;
  for (std::size_t i = 0; i < size; ++i) {
    double in = 0.0, out = 0.0, square = 0.0;
    for (const auto& part : parts) in += part.in[i], out += part.out[i];
    if (!(in > 0.0)) continue;
    const double share = escape.share[i] = out / in;
    for (const auto& part : parts) square += (part.out[i] - share * part.in[i]) * (part.out[i] - share * part.in[i]);
    escape.standard_error[i] = std::sqrt(square * batches / (batches - 1.0)) / in;
  }
  return escape;
}

}  // namespace sunfleck
