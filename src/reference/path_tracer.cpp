#include <sunfleck/reference/path_tracer.hpp>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>
#include <vector>

#include <sunfleck/core/timer.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/visibility/endless_light.hpp>

#include "sensor_paths.hpp"

namespace sunfleck {

namespace {

/// Rows of one block of facets, and their sums.
class Block {
 public:
  Block(const RayScene& facets, const PathSampler& sampler, std::size_t count)
      : facets_(facets),
        sampler_(sampler),
        states_(sampler.states()),
        bands_(sampler.bands()),
        means_(count * reference_randomisations),
        irradiance_(count * states_ * 2 * bands_),
        sunlit_(count * states_ * 2),
        variance_(count * states_ * bands_) {}

  void trace(std::size_t first, std::size_t count, std::uint32_t samples, const Progress& progress) {
    tbb::parallel_for(std::size_t{0}, count * reference_randomisations, [&](std::size_t item) {
      if (progress.cancelled()) return;
      const std::uint64_t row = first + item / reference_randomisations;
      const SampleTarget target(facets_, {facets_.at(row)}, row);
      sampler_.sample(target, static_cast<std::uint32_t>(item % reference_randomisations), samples, 1, means_[item]);
    });
  }

  /// Means of the randomisations into rows [s][count]..., balance and variances, facet by facet in order.
  void collect(std::size_t first, std::size_t count, SolveReport& report, std::uint64_t& rays) {
    constexpr double n = reference_randomisations;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t facet = first + i;
      const double area = static_cast<float>(glm::length(area_vector(facets_.corners(facets_.at(facet)))));
      const auto* parts = &means_[i * reference_randomisations];
      const auto mean = [&](std::vector<double> SampleMeans::*field, std::size_t k) {
        double sum = 0.0;
        for (std::uint32_t r = 0; r < reference_randomisations; ++r) sum += (parts[r].*field)[k];
        return sum / n;
      };
      for (std::uint32_t r = 0; r < reference_randomisations; ++r) rays += parts[r].rays;
      for (std::size_t s = 0; s < states_; ++s) {
        for (std::size_t k = 0; k < 2 * bands_; ++k)
          irradiance_[(s * count + i) * 2 * bands_ + k] = static_cast<float>(mean(&SampleMeans::irradiance, s * 2 * bands_ + k));
        for (std::size_t k = 0; k < 2; ++k) sunlit_[(s * count + i) * 2 + k] = static_cast<float>(mean(&SampleMeans::sunlit, s * 2 + k));
        for (std::size_t b = 0; b < bands_; ++b) {
          const double absorbed = mean(&SampleMeans::absorbed, s * bands_ + b);
          double square = 0.0;
          for (std::uint32_t r = 0; r < reference_randomisations; ++r) {
            const double difference = parts[r].absorbed[s * bands_ + b] - absorbed;
            square += difference * difference;
          }
          const double variance = square / (n * (n - 1.0));
          variance_[(s * count + i) * bands_ + b] = static_cast<float>(variance);
          auto& balance = report.balance[s][b];
          balance.incident +=
              area * (mean(&SampleMeans::direct, 2 * s * bands_ + b) + mean(&SampleMeans::direct, (2 * s + 1) * bands_ + b));
          (facet < facets_.plant_facets() ? balance.leaves : balance.ground) += area * absorbed;
        }
      }
    }
  }

  IrradianceRows rows(std::size_t first, std::size_t count) const {
    return {first, count, irradiance_.data(), sampler_.has_sun() ? sunlit_.data() : nullptr, variance_.data()};
  }

 private:
  const RayScene& facets_;
  const PathSampler& sampler_;
  std::size_t states_, bands_;
  std::vector<SampleMeans> means_;  ///< [count][randomisation]
  std::vector<float> irradiance_, sunlit_, variance_;
};

/// Of facets with an area: the same whether copies are written out or not, so that sensors stand where they stand with other methods.
const Box& bounds_of(const FacetScene& facets) {
  return facets.bounds;
}

Box bounds_of(const FacetRows& rows) {
  Box bounds;
  for (std::uint32_t copy = 0; copy <= rows.placed().copies.size(); ++copy)
    rows.visit(copy, 0, rows.facet_count(copy), [&](std::uint64_t, const Triangle& corners, std::uint32_t, std::uint32_t) {
      if (static_cast<float>(glm::length(area_vector(corners))) > 0.0f)
        for (const auto& p : corners) bounds.add(p);
    });
  return bounds;
}

template <class Facets>
SolveReport trace(const Scene& scene, const Facets& facets, const ReferenceSettings& settings, IrradianceSink& sink, Progress& progress) {
  SolveReport report;
  report.method = "reference";
  const std::size_t states = scene.states.size(), bands = scene.band_count();
  report.balance.assign(states, std::vector<Balance>(bands));
  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);

  Stopwatch building;
  const RayScene rays(facets);
  const std::size_t n = settings.facets > 0 ? std::min<std::size_t>(settings.facets, rays.facet_count()) : rays.facet_count();
  check_lamplight_ends(scene, rays);
  const PathSampler sampler(scene, rays, settings.seed);
  add_seconds(report.timings, "build the tree of rays", building.seconds());

  Stopwatch tracing;
  const std::uint32_t samples = std::max<std::uint32_t>(1, (settings.samples + reference_randomisations - 1) / reference_randomisations);
  // Blocks of about 10^5 paths, so that the user is heard several times a second, and no more than some 10 MB of sums.
  const std::size_t block_size =
      std::clamp<std::size_t>(std::min<std::size_t>(65536 / (samples * reference_randomisations),
                                                    (std::size_t{1} << 20) / (reference_randomisations * states * (5 * bands + 2))),
                              1, 4096);
  Block block(rays, sampler, std::min(block_size, n));
  std::uint64_t ray_count = 0;
  for (std::size_t first = 0; first < n; first += block_size) {
    progress.check();
    progress.fraction("reference", static_cast<double>(first) / static_cast<double>(n));
    const std::size_t count = std::min(block_size, n - first);
    arena.execute([&] { block.trace(first, count, samples, progress); });
    progress.check();
    block.collect(first, count, report, ray_count);
    sink.rows(block.rows(first, count));
  }
  progress.fraction("reference", 1.0);
  add_seconds(report.timings, "paths", tracing.seconds());

  Stopwatch balancing;
  const std::size_t work = std::size_t{n} * samples;  // as many particles as a sixteenth of the paths, within bounds
  PathSampler::Escape escape;
  if (settings.facets > 0)
    escape.share.assign(states * bands, 0.0);
  else
    arena.execute(
        [&] { escape = sampler.escape_share(static_cast<std::uint32_t>(std::clamp<std::size_t>(work / (16 * states), 64, 4096))); });
  for (std::size_t s = 0; s < states; ++s)
    for (std::size_t b = 0; b < bands; ++b) report.balance[s][b].escaped = report.balance[s][b].incident * escape.share[s * bands + b];
  add_seconds(report.timings, "balance", balancing.seconds());

  Stopwatch sensing;
  std::uint64_t sensor_rays = 0;
  if (!scene.sensors.empty()) {
    arena.execute([&] { report.sensors = sensor_readings(scene, bounds_of(facets), sampler, settings.samples, sensor_rays, progress); });
    add_seconds(report.timings, "sensors", sensing.seconds());
  }

  report.counts = {{"samples per facet", std::uint64_t{samples} * reference_randomisations},
                   {"rays", ray_count + escape.rays},
                   {"stacked pairs", rays.stacked_pairs()}};
  if (!scene.sensors.empty()) report.counts.emplace_back("sensor_rays", sensor_rays);
  report.memory = {{"tree of rays", rays.bytes()}};
  return report;
}

}  // namespace

SolveReport trace_reference(const Scene& scene, const FacetScene& facets, const ReferenceSettings& settings, IrradianceSink& sink,
                            Progress& progress) {
  return trace(scene, facets, settings, sink, progress);
}

SolveReport trace_reference(const Scene& scene, const FacetRows& rows, const ReferenceSettings& settings, IrradianceSink& sink,
                            Progress& progress) {
  return trace(scene, rows, settings, sink, progress);
}

}  // namespace sunfleck
