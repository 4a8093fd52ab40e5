#include <sunfleck/reference/path_sampler.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>

namespace sunfleck {

namespace {

constexpr double pi = std::numbers::pi;

/// Unit vector about n with a density of cos / pi.
Vec3 cosine_direction(const Vec3& n, double u, double v) {
  Vec3 a, b;
  orthonormal_frame(n, a, b);
  const double r = std::sqrt(u), azimuth = 2.0 * pi * v;
  return r * std::cos(azimuth) * a + r * std::sin(azimuth) * b + std::sqrt(1.0 - u) * n;
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

  FacetPlane plane(CopyFacet facet) const { return FacetPlane(rays.corners(facet)); }
  std::size_t material(CopyFacet facet) const { return rays.material(facet) * bands; }

  /// Calls hit(state, on_front, irradiance factor: cosine to the sun, 0 < factor) for each state whose sun reaches the point.
  template <class Hit>
  void sun_at(const Vec3& p, CopyFacet facet, const Vec3& n, double u, double v, std::uint64_t& count, Hit&& hit) const;

  /// Follows a ray through the scene. hit(bounce, facet, point, normal, front) at every facet met, before it scatters; exit(bounce,
  /// direction) if it leaves. `weight` [b] begins at 1.
  template <class Hit, class Exit>
  void walk(Vec3 p, Vec3 d, CopyFacet facet, double* weight, RandomStream& random, std::uint64_t& count, Hit&& hit, Exit&& exit) const;

  void one_side(const Vec3& p, const Vec3& d, CopyFacet facet, RandomStream& random, double* weight, double* sum, double* direct,
                std::uint64_t& count) const;

  double absorptance(CopyFacet facet, bool on_front, std::size_t b) const {
    const auto m = material(facet) + b;
    return std::max(0.0, 1.0 - (on_front ? front : back)[m] - through[m]);
  }
  /// Light by paths, which leave out the sun on the start itself; and that sun. Both add to sums over `count` samples.
  void add_paths(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, SampleMeans& sums) const;
  void add_sun(const SampleTarget& target, std::uint64_t stream, std::uint32_t count, double share, SampleMeans& sums) const;

  struct Particles {
    std::vector<double> in, out;  ///< [s][b]
    std::uint64_t rays = 0;
  };
  Particles particles(std::uint32_t batch, std::uint32_t count) const;

  const RayScene& rays;
  std::uint64_t seed;
  std::size_t states, bands;
  bool has_sun = false;
  std::vector<Beam> beams;                   ///< [s]
  std::vector<const Sky*> skies;             ///< [s], null = none
  std::vector<double> front, back, through;  ///< [material][b]
};

PathSampler::Impl::Impl(const Scene& scene, const RayScene& r, std::uint64_t s)
    : rays(r), seed(s), states(scene.states.size()), bands(scene.band_count()) {
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
    if (c == 0.0) continue;
    ++count;
    // The sun's irradiance is on a plane that faces its centre: the disc's mean cosine there is (1 + cos radius) / 2.
    if (!rays.occluded(p, d, facet)) hit(s, c > 0.0, std::abs(c) * 2.0 / (1.0 + beam.cos_radius));
  }
}

template <class Hit, class Exit>
void PathSampler::Impl::walk(Vec3 p, Vec3 d, CopyFacet facet, double* weight, RandomStream& random, std::uint64_t& count, Hit&& hit,
                             Exit&& exit) const {
  for (int bounce = 0;; ++bounce) {
    ++count;
    const RayHit met = rays.first_hit(p, d, facet);
    if (!met) return exit(bounce, d);
    facet = met.where();
    const FacetPlane here = plane(facet);
    p = here.point(met.u, met.v);
    Vec3 n = here.normal;
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

void PathSampler::Impl::one_side(const Vec3& start, const Vec3& direction, CopyFacet facet, RandomStream& random, double* weight,
                                 double* sum, double* direct, std::uint64_t& count) const {
  std::fill_n(weight, bands, 1.0);
  walk(
      start, direction, facet, weight, random, count,
      [&](int, CopyFacet f, const Vec3& p, const Vec3& n, bool on_front) {
        if (!has_sun) return;
        const double u = random.next(), v = random.next();
        const auto m = material(f);
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
    one_side(p, cosine_direction(n, sobol_owen(i, 2, scramble), sobol_owen(i, 3, scramble)), facet, random, weight.data(), here.data(),
             sums.direct.data(), sums.rays);
    one_side(p, cosine_direction(-n, sobol_owen(i, 4, scramble), sobol_owen(i, 5, scramble)), facet, random, weight.data(),
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
  if (my.has_sun) my.add_sun(target, stream, count * sun_points, 1.0 / sun_points, means);
  for (auto* sums : {&means.irradiance, &means.direct, &means.absorbed, &means.sunlit})
    for (auto& value : *sums) value /= count;
}

PathSampler::Impl::Particles PathSampler::Impl::particles(std::uint32_t batch, std::uint32_t count) const {
  Particles sum{std::vector<double>(states * bands, 0.0), std::vector<double>(states * bands, 0.0), 0};
  if (rays.bounds().empty()) return sum;
  const Vec3 centre = rays.bounds().centre();
  const double radius = 0.5 * glm::length(rays.bounds().size());
  std::vector<double> weight(bands);
  // Sends one particle that stands for power[b] along the line that comes from direction d, through the point u, v of a disc that
  // holds the scene's shadow, or of the cell's top or bottom.
  const auto send = [&](std::size_t s, const Vec3& d, double u, double v, double factor, const std::vector<double>& irradiance,
                        RandomStream& random) {
    Vec3 from;
    if (rays.periodic()) {
      const auto& cell = *rays.periodic();
      const double margin = 1e-3 * (rays.bounds().size().z + cell.width());
      from = {cell.x_low + u * cell.width(), cell.y_low + v * cell.depth(),
              d.z > 0.0 ? rays.bounds().high.z + margin : rays.bounds().low.z - margin};
      factor *= cell.area() * std::abs(d.z);
    } else {
      Vec3 a, b;
      orthonormal_frame(d, a, b);
      const double r = radius * std::sqrt(u);
      from = centre + 2.0 * radius * d + r * std::cos(2.0 * pi * v) * a + r * std::sin(2.0 * pi * v) * b;
      factor *= pi * radius * radius;
    }
    std::fill(weight.begin(), weight.end(), 1.0);
    walk(
        from, -d, nowhere, weight.data(), random, sum.rays,
        [&](int bounce, CopyFacet, const Vec3&, const Vec3&, bool) {
          if (bounce == 0)
            for (std::size_t b = 0; b < bands; ++b) sum.in[s * bands + b] += factor * irradiance[b];
        },
        [&](int bounce, const Vec3&) {
          if (bounce > 0)
            for (std::size_t b = 0; b < bands; ++b) sum.out[s * bands + b] += factor * irradiance[b] * weight[b];
        });
  };
  for (std::size_t s = 0; s < states; ++s) {
    const std::uint64_t stream = mix(seed ^ 0x65736361ULL, s, batch);
    const auto scramble = static_cast<std::uint32_t>(stream);
    for (std::uint32_t i = 0; i < count; ++i) {
      RandomStream random(mix(stream, i));
      const auto x = [&](unsigned dimension) { return sobol_owen(i, dimension, scramble); };
      if (const auto& beam = beams[s]; beam.sun) send(s, beam.direction(x(2), x(3)), x(0), x(1), 1.0, beam.sun->irradiance, random);
      if (const Sky* sky = skies[s]) {
        // Uniform over the upper hemisphere, or over the sphere if light comes from there.
        const bool all_round = sky->reaches_below_horizon();
        const double z = all_round ? 2.0 * x(6) - 1.0 : x(6), r = std::sqrt(1.0 - z * z), azimuth = 2.0 * pi * x(7);
        const Vec3 d{r * std::cos(azimuth), r * std::sin(azimuth), z};
        send(s, d, x(4), x(5), (all_round ? 4.0 : 2.0) * pi * sky->relative_radiance(d), sky->irradiance, random);
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
