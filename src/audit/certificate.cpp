#include <sunfleck/audit/certificate.hpp>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/reference/path_tracer.hpp>

#include "audit/error_interval.hpp"
#include "audit/organ_choice.hpp"
#include "audit/solved_light.hpp"

namespace sunfleck {

namespace {

constexpr std::uint32_t sun_points = 8;  // a shadow ray is a tenth of a sample's cost, and direct sun most of its variance

/// Rays become dearer as the tree outgrows the caches: about as the root of the number of facets.
std::uint64_t rays_for(std::size_t facets) {
  return static_cast<std::uint64_t>(2.0e6 * std::clamp(std::sqrt(1e5 / static_cast<double>(facets)), 0.3, 1.0));
}

std::vector<SampleTarget> targets_of(const FacetRows& rows, const RayScene& rays, const std::vector<ChosenOrgan>& chosen) {
  std::vector<SampleTarget> targets;
  for (const auto& c : chosen) {
    const auto [copy, organ] = rows.organ_at(c.organ);
    std::vector<CopyFacet> facets;
    for (const auto f : rows.organ_facets(copy, organ)) facets.push_back(rays.at(rows.row({copy, f})));
    targets.emplace_back(rays, std::move(facets), c.organ);
  }
  return targets;
}

/// Nothing where the user wants to stop.
TracedLight measure(const PathSampler& sampler, const SampleTarget& target, std::uint32_t count, const Progress& progress) {
  constexpr double n = reference_randomisations;
  const std::size_t bands = sampler.bands(), size = sampler.states() * bands;
  std::vector<SampleMeans> parts(reference_randomisations);
  TracedLight out;
  for (std::uint32_t r = 0; r < reference_randomisations; ++r) {
    if (progress.cancelled()) return {};
    sampler.sample(target, r, count, sun_points, parts[r]);
    out.rays += parts[r].rays;
  }
  const auto fill = [&](std::vector<double>& mean, std::vector<double>& variance, auto value) {
    mean.assign(size, 0.0), variance.assign(size, 0.0);
    for (std::size_t i = 0; i < size; ++i) {
      for (const auto& part : parts) mean[i] += value(part, i) / n;
      for (const auto& part : parts) variance[i] += (value(part, i) - mean[i]) * (value(part, i) - mean[i]) / (n * (n - 1.0));
    }
  };
  fill(out.absorbed, out.absorbed_variance, [](const SampleMeans& part, std::size_t i) { return part.absorbed[i]; });
  fill(out.irradiance, out.irradiance_variance, [bands](const SampleMeans& part, std::size_t i) {
    const std::size_t row = 2 * (i / bands) * bands + i % bands;
    return part.irradiance[row] + part.irradiance[row + bands];
  });
  return out;
}

/// `place` [k] says where the chosen ones are among those of `solved`.
void estimate_band(std::size_t b, const OrganTotals& solved, const std::vector<ChosenOrgan>& chosen, const std::vector<std::size_t>& place,
                   const std::vector<TracedLight>& measured, bool irradiance, Certificate& out) {
  constexpr double freedom = reference_randomisations - 1.0;
  const double states = static_cast<double>(solved.states);
  std::vector<OrganError> errors;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    OrganError error{chosen[k].share, chosen[k].certain};
    double noise_of_squares = 0.0, noise = 0.0;  // standard deviations: states share paths, so that they may vary together
    for (std::size_t s = 0; s < solved.states; ++s) {
      const std::size_t i = s * solved.bands + b;
      const double r = irradiance ? measured[k].irradiance[i] : measured[k].absorbed[i];
      const double v = irradiance ? measured[k].irradiance_variance[i] : measured[k].absorbed_variance[i];
      const double d = solved_per_area(solved, s, place[k], b, irradiance) - r, square = d * d - v;
      error.difference += d / states;
      error.square += square / states;
      noise += std::sqrt(v) / states;
      noise_of_squares += std::sqrt(4.0 * std::max(0.0, square) * v + 2.0 * v * v * (1.0 + 1.0 / freedom)) / states;
    }
    error.difference_variance = noise * noise;
    error.square_variance = noise_of_squares * noise_of_squares;
    errors.push_back(error);
  }
  const ErrorEstimate estimate = estimate_error(errors);
  constexpr double least = 1e-3;  // of what is solved: where paths find next to no light, an error is large, not undefined
  const double mean_solved = solved.plant_area > 0.0 ? mean_light(solved, b, irradiance) : 0.0;
  const double mean = std::max(mean_solved - estimate.bias, least * mean_solved);
  const auto relative = [mean](double value) { return mean > 0.0 ? value / mean : 0.0; };  // no light at all: no error either
  out.rmse.push_back(relative(estimate.rmse));
  out.rmse_low.push_back(relative(estimate.low));
  out.rmse_high.push_back(relative(estimate.high));
  out.bias.push_back(relative(estimate.bias));
  out.bias_standard_error.push_back(relative(estimate.bias_standard_error));
  out.square_standard_error.push_back(relative(relative(estimate.square_standard_error)));
}

}  // namespace

TracedOrgans trace_organs(const Scene& scene, const FacetRows& rows, const RayScene& rays, const std::vector<ChosenOrgan>& candidates,
                          const CertificateSettings& settings, Progress& progress) {
  TracedOrgans out;
  out.seed = settings.seed;
  auto& chosen = out.chosen;
  auto& measured = out.light;
  chosen = candidates;
  if (chosen.empty()) return out;
  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
  const PathSampler sampler(scene, rays, certificate_seed(settings));
  progress.check();

  // What a sample costs: one of each randomisation on a few organs. Counted in rays, so the same everywhere.
  auto targets = targets_of(rows, rays, chosen);
  const std::size_t pilots = std::min<std::size_t>(16, targets.size());
  std::vector<std::uint64_t> cost(pilots);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, pilots,
                      [&](std::size_t p) { cost[p] = measure(sampler, targets[p * targets.size() / pilots], 1, progress).rays; });
  });
  std::uint64_t pilot_rays = 0;
  for (const auto c : cost) pilot_rays += c;
  out.rays += pilot_rays;
  const double per_pass = std::max(1.0, static_cast<double>(pilot_rays) / static_cast<double>(pilots));  // 16 samples of one organ
  const double passes = static_cast<double>(settings.rays > 0 ? settings.rays : rays_for(rows.placed().facets)) / per_pass;
  const std::size_t affordable = std::max<std::size_t>(64, static_cast<std::size_t>(passes));
  if (affordable < chosen.size()) {
    chosen = choose_fewer(chosen, static_cast<std::uint32_t>(affordable), settings);
    targets = targets_of(rows, rays, chosen);
  }
  const auto count = static_cast<std::uint32_t>(std::clamp(passes / static_cast<double>(chosen.size()), 1.0, 65536.0));
  measured.resize(chosen.size());
  constexpr std::size_t block = 16;  // organs between two questions whether to stop
  for (std::size_t first = 0; first < chosen.size(); first += block) {
    progress.check();
    progress.fraction("certificate", static_cast<double>(first) / static_cast<double>(chosen.size()));
    const std::size_t last = std::min(first + block, chosen.size());
    arena.execute(
        [&] { tbb::parallel_for(first, last, [&](std::size_t k) { measured[k] = measure(sampler, targets[k], count, progress); }); });
  }
  progress.check();
  progress.fraction("certificate", 1.0);
  for (const auto& m : measured) out.rays += m.rays;
  return out;
}

Certificate judge(const TracedOrgans& traced, const OrganTotals& solved, const std::vector<std::vector<Balance>>& balance) {
  const auto& chosen = traced.chosen;
  const auto& measured = traced.light;
  Certificate out;
  out.seed = traced.seed;
  out.rays = traced.rays;
  for (const auto& c : chosen) out.organs.push_back(c.organ);
  const auto place = places_of(chosen, solved);
  for (std::size_t s = 0; s < solved.states; ++s)
    for (std::size_t k = 0; k < chosen.size(); ++k)
      for (std::size_t b = 0; b < solved.bands; ++b) {
        const double area = solved.area[place[k]];
        out.solved.push_back(static_cast<float>(solved.absorbed_power(s, place[k], b)));
        out.reference.push_back(static_cast<float>(area * measured[k].absorbed[s * solved.bands + b]));
        out.standard_error.push_back(static_cast<float>(area * std::sqrt(measured[k].absorbed_variance[s * solved.bands + b])));
      }
  for (std::size_t b = 0; b < solved.bands; ++b) estimate_band(b, solved, chosen, place, measured, compares_irradiance(balance, b), out);
  return out;
}

Certificate certify(const Scene& scene, const FacetRows& rows, const RayScene& rays, const std::vector<ChosenOrgan>& chosen,
                    const OrganTotals& solved, const std::vector<std::vector<Balance>>& balance, const CertificateSettings& settings,
                    Progress& progress) {
  if (solved.organs.size() != chosen.size()) throw Error("certificate: the solved light of other organs than those chosen");
  return judge(trace_organs(scene, rows, rays, chosen, settings, progress), solved, balance);
}

}  // namespace sunfleck
