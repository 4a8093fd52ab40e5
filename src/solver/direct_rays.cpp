#include "solver/direct_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/light/light_sources.hpp>
#include <sunfleck/visibility/rays.hpp>

namespace sunfleck {

namespace {

using std::numbers::pi;
constexpr std::size_t rows_at_once = 16384, rows_a_task = 256;
constexpr std::uint32_t most_rays = 64, points_of_disc = 61;

class DirectRays {
 public:
  DirectRays(const Scene& scene, const FacetScene& facets, const DirectRaysSettings& settings, IrradianceSink& sink, Progress& progress)
      : scene_(scene),
        facets_(facets),
        sink_(sink),
        progress_(progress),
        sources_(light_sources(scene.states)),
        shift_{unit_interval(mix(settings.seed, 1)), unit_interval(mix(settings.seed, 2))} {
    const double wanted =
        settings.rays_per_organ * static_cast<double>(facets.organs.size()) / static_cast<double>(std::max<std::size_t>(facets.size(), 1));
    rays_ = static_cast<std::uint32_t>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(most_rays)));
    for (const auto* sun : sources_.suns) discs_.push_back(sun_disc(*sun, points_of_disc, settings.seed));
    for (const auto* sky : sources_.skies) round_ = round_ || sky->reaches_below_horizon();
  }

  SolveReport run(const RayScene& world) {
    SolveReport report;
    report.method = "direct";
    report.balance.assign(states(), std::vector<Balance>(bands()));
    Stopwatch watch;
    const std::size_t n = facets_.size(), skies = sources_.skies.size(), suns = sources_.suns.size();
    std::vector<float> irradiance, sunlit;
    std::vector<std::vector<Balance>> partial(rows_at_once / rows_a_task);
    for (std::size_t first = 0; first < n; first += rows_at_once) {
      progress_.check();
      progress_.fraction("direct light", static_cast<double>(first) / static_cast<double>(n));
      const std::size_t count = std::min(rows_at_once, n - first), blocks = (count + rows_a_task - 1) / rows_a_task;
      irradiance.assign(states() * count * 2 * bands(), 0.0f);
      if (suns > 0) sunlit.assign(states() * count * 2, 0.0f);
      tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        partial[b].assign(states() * bands(), Balance{});
        std::vector<double> sky(2 * skies), lit(2 * suns), beam(2 * suns);
        for (std::size_t i = b * rows_a_task; i < std::min(count, (b + 1) * rows_a_task); ++i) {
          const auto f = static_cast<std::uint32_t>(first + i);
          if (!(facets_.area[f] > 0.0f)) continue;
          trace(world, f, sky, lit, beam);
          store(f, i, count, sky, lit, beam, irradiance, sunlit, partial[b]);
        }
      });
      for (std::size_t b = 0; b < blocks; ++b)
        for (std::size_t c = 0; c < partial[b].size(); ++c) {
          auto& sums = report.balance[c / bands()][c % bands()];
          sums.incident += partial[b][c].incident, sums.leaves += partial[b][c].leaves, sums.ground += partial[b][c].ground;
        }
      sink_.rows({first, count, irradiance.data(), suns > 0 ? sunlit.data() : nullptr, nullptr});
    }
    for (auto& state : report.balance)
      for (auto& b : state) b.escaped = b.incident - b.leaves - b.ground;
    add_seconds(report.timings, "rays to sun and sky", watch.seconds());
    report.counts = {{"rays", n * rays_ * ((skies > 0 ? 1 : 0) + suns)}};
    return report;
  }

 private:
  std::size_t states() const { return scene_.states.size(); }
  std::size_t bands() const { return scene_.band_count(); }

  void trace(const RayScene& world, std::uint32_t f, std::vector<double>& sky, std::vector<double>& lit, std::vector<double>& beam) const {
    const CopyFacet start = world.at(f);
    const Triangle t = world.met_corners(start);
    const Vec3 normal = glm::normalize(area_vector(facets_.corners[f]));
    for (auto* values : {&sky, &lit, &beam}) std::fill(values->begin(), values->end(), 0.0);
    for (std::uint32_t r = 0; r < rays_; ++r) {
      const std::uint64_t number = std::uint64_t{f} * rays_ + r;
      const auto on_facet = r2_point(number, unit_interval(mix(number / 64)), 0.5);
      const auto towards = r2_point(number, shift_[0], shift_[1]);
      const double root = std::sqrt(on_facet[0]);
      const Vec3 origin = t[0] + root * (1.0 - on_facet[1]) * (t[1] - t[0]) + root * on_facet[1] * (t[2] - t[0]);
      if (!sources_.skies.empty()) {
        const double z = round_ ? 1.0 - 2.0 * towards[0] : towards[0], s = std::sqrt(std::max(0.0, 1.0 - z * z));
        const Vec3 d{s * std::cos(2.0 * pi * towards[1]), s * std::sin(2.0 * pi * towards[1]), z};
        const double cosine = glm::dot(normal, d);
        if (cosine != 0.0 && !world.occluded(origin, d, start))
          for (std::size_t k = 0; k < sources_.skies.size(); ++k)
            sky[2 * k + (cosine > 0.0 ? 0 : 1)] +=
                (round_ ? 4.0 : 2.0) * pi / rays_ * sources_.skies[k]->relative_radiance(d) * std::abs(cosine);
      }
      for (std::size_t k = 0; k < sources_.suns.size(); ++k) {
        const Vec3 d = discs_[k][mix(number) % discs_[k].size()];
        const double cosine = glm::dot(normal, d);
        if (cosine == 0.0 || world.occluded(origin, d, start)) continue;
        lit[2 * k + (cosine > 0.0 ? 0 : 1)] += 1.0 / rays_;
        beam[2 * k + (cosine > 0.0 ? 0 : 1)] += std::abs(cosine) / rays_;
      }
    }
  }

  void store(std::size_t f, std::size_t i, std::size_t count, const std::vector<double>& sky, const std::vector<double>& lit,
             const std::vector<double>& beam, std::vector<float>& irradiance, std::vector<float>& sunlit,
             std::vector<Balance>& sums) const {
    const auto& o = facets_.materials[facets_.optics[f]];
    for (std::size_t s = 0; s < states(); ++s) {
      const auto sky_row = sources_.sky_of_state[s], sun_row = sources_.sun_of_state[s];
      for (std::size_t side = 0; side < 2; ++side) {
        if (sun_row != LightSources::none) sunlit[(s * count + i) * 2 + side] = static_cast<float>(lit[2 * sun_row + side]);
        for (std::size_t b = 0; b < bands(); ++b) {
          double e = 0.0;
          if (sky_row != LightSources::none) e += scene_.states[s].sky->irradiance[b] * sky[2 * sky_row + side];
          if (sun_row != LightSources::none) e += scene_.states[s].sun->irradiance[b] * beam[2 * sun_row + side];
          irradiance[((s * count + i) * 2 + side) * bands() + b] = static_cast<float>(e);
          const double kept = 1.0 - (side == 0 ? o.reflectance_front : o.reflectance_back)[b] - o.transmittance[b];
          auto& balance = sums[s * bands() + b];
          balance.incident += facets_.area[f] * e;
          (f < facets_.plant_facets ? balance.leaves : balance.ground) += facets_.area[f] * kept * e;
        }
      }
    }
  }

  const Scene& scene_;
  const FacetScene& facets_;
  IrradianceSink& sink_;
  Progress& progress_;
  const LightSources sources_;
  const std::array<double, 2> shift_;
  std::uint32_t rays_ = 1;
  std::vector<std::vector<Vec3>> discs_;  ///< [suns] points
  bool round_ = false;                    ///< a sky below the horizon, too
};

}  // namespace

SolveReport direct_by_rays(const Scene& scene, const FacetScene& facets, const RayScene& rays, const DirectRaysSettings& settings,
                           IrradianceSink& sink, Progress& progress) {
  return DirectRays(scene, facets, settings, sink, progress).run(rays);
}

}  // namespace sunfleck
