#include <sunfleck/audit/certificate.hpp>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/reference/path_sampler.hpp>
#include <sunfleck/reference/path_tracer.hpp>

#include "error_interval.hpp"

namespace sunfleck {

namespace {

constexpr std::uint32_t sun_points = 8;  // a shadow ray is a tenth of a sample's cost, and direct sun most of its variance
constexpr double least_absorbed = 1e-6;  // of the incident light; below it irradiance is compared

struct Checked {
  std::uint32_t organ = 0;
  double share = 0;  ///< of the area of all organs of plants
  bool certain = false;
};

/// Rays become dearer as the tree outgrows the caches: about as the root of the number of facets.
std::uint64_t rays_for(std::size_t facets) {
  return static_cast<std::uint64_t>(2.0e6 * std::clamp(std::sqrt(1e5 / static_cast<double>(facets)), 0.3, 1.0));
}

/// Organs of plants, rising, drawn with a probability proportional to their area plus three times the mean area: small organs weigh
/// little but have the largest errors (on a coffee plant organs that make a tenth of the area hold nine tenths of the square error
/// in NIR), and one drawn by its area alone would weigh as much as a large one. All for sure if there are no more than `wanted`.
/// Shares of those drawn are area / probability, scaled to the area that they stand for together.
std::vector<Checked> draw(const FacetScene& facets, const OrganTotals& solved, std::uint32_t wanted, double offset) {
  std::vector<Checked> population;
  double total = 0.0;
  for (std::uint32_t m = 0; m < solved.organs; ++m)
    if (facets.organs.structure[m] != no_parent && solved.area[m] > 0.0) {
      population.push_back({m, solved.area[m], false});
      total += solved.area[m];
    }
  const double mean = total / static_cast<double>(std::max<std::size_t>(population.size(), 1));
  const auto size = [mean](const Checked& c) { return c.share + 3.0 * mean; };
  double rest = 4.0 * total;
  std::size_t places = wanted;
  if (population.size() <= wanted) {
    for (auto& c : population) c.certain = true;
  } else {
    // Those larger than the step are taken for sure; that makes the step for the others smaller, until none is left over.
    for (bool changed = true; changed && places > 0;) {
      changed = false;
      const double step = rest / static_cast<double>(places);
      for (auto& c : population)
        if (!c.certain && size(c) >= step && places > 0) c.certain = changed = true, rest -= size(c), --places;
    }
  }
  std::vector<Checked> chosen;
  const double step = rest / static_cast<double>(std::max<std::size_t>(places, 1));
  double passed = 0.0, next = offset * step, by_chance = 0.0, drawn = 0.0;
  for (const auto& c : population) {
    if (c.certain) {
      chosen.push_back({c.organ, c.share / total, true});
      continue;
    }
    by_chance += c.share / total;
    passed += size(c);
    if (places == 0 || passed <= next) continue;
    chosen.push_back({c.organ, c.share / size(c), false});
    drawn += chosen.back().share;
    next += step;
  }
  for (auto& c : chosen)
    if (!c.certain) c.share *= by_chance / drawn;
  return chosen;
}

std::vector<SampleTarget> targets_of(const FacetScene& facets, const std::vector<Checked>& chosen) {
  std::vector<std::uint32_t> place(facets.organs.size(), no_facet);
  for (std::uint32_t k = 0; k < chosen.size(); ++k) place[chosen[k].organ] = k;
  std::vector<std::vector<std::uint32_t>> rows(chosen.size());
  for (std::uint32_t f = 0; f < facets.plant_facets; ++f)
    if (const auto k = place[facets.organ[f]]; k != no_facet) rows[k].push_back(f);
  std::vector<SampleTarget> targets;
  for (std::uint32_t k = 0; k < chosen.size(); ++k) targets.emplace_back(facets, std::move(rows[k]), chosen[k].organ);
  return targets;
}

/// Path-traced means of an organ and the variance of their mean, for absorbed and irradiance (front + back) per area.
struct Measured {
  std::vector<double> absorbed, absorbed_variance, irradiance, irradiance_variance;  ///< [s][b]
  std::uint64_t rays = 0;
};

Measured measure(const PathSampler& sampler, const SampleTarget& target, std::uint32_t count) {
  constexpr double n = reference_randomisations;
  const std::size_t bands = sampler.bands(), size = sampler.states() * bands;
  std::vector<SampleMeans> parts(reference_randomisations);
  Measured out;
  for (std::uint32_t r = 0; r < reference_randomisations; ++r) {
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

/// Solved light per area: absorbed, or irradiance front + back.
double solved_per_area(const OrganTotals& solved, std::size_t s, std::size_t organ, std::size_t b, bool irradiance) {
  if (!irradiance) return solved.absorbed_power(s, organ, b) / solved.area[organ];
  const double* sides = &solved.irradiance[((s * solved.organs + organ) * 2) * solved.bands + b];
  return (sides[0] + sides[solved.bands]) / solved.area[organ];
}

void estimate_band(std::size_t b, const FacetScene& facets, const OrganTotals& solved, const std::vector<Checked>& chosen,
                   const std::vector<Measured>& measured, bool irradiance, Certificate& out) {
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
      const double d = solved_per_area(solved, s, chosen[k].organ, b, irradiance) - r, square = d * d - v;
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
  double light = 0.0, area = 0.0;
  for (std::size_t m = 0; m < solved.organs; ++m) {
    if (facets.organs.structure[m] == no_parent || !(solved.area[m] > 0.0)) continue;
    area += solved.area[m];
    for (std::size_t s = 0; s < solved.states; ++s) light += solved.area[m] * solved_per_area(solved, s, m, b, irradiance) / states;
  }
  const double mean = area > 0.0 ? light / area - estimate.bias : 0.0;
  const auto relative = [mean](double value) { return mean > 0.0 ? value / mean : 0.0; };  // no light at all: no error either
  out.rmse.push_back(relative(estimate.rmse));
  out.rmse_low.push_back(relative(estimate.low));
  out.rmse_high.push_back(relative(estimate.high));
  out.bias.push_back(relative(estimate.bias));
  out.bias_standard_error.push_back(relative(estimate.bias_standard_error));
}

}  // namespace

Certificate certify(const Scene& scene, const FacetScene& facets, const OrganTotals& solved,
                    const std::vector<std::vector<Balance>>& balance, const CertificateSettings& settings, Progress& progress) {
  Certificate out;
  out.seed = settings.seed;
  const std::uint64_t seed = mix(settings.seed, 0x6365727469667921ULL);  // not the numbers of the solve, nor of the reference method
  const double offset = unit_interval(mix(seed, 0));
  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
  const RayScene rays(facets);
  const PathSampler sampler(scene, facets, rays, seed);
  progress.check();

  auto chosen = draw(facets, solved, settings.organs, offset);
  std::vector<Measured> measured;
  if (!chosen.empty()) {
    // What a sample costs: one of each randomisation on a few organs. Counted in rays, so the same everywhere.
    auto targets = targets_of(facets, chosen);
    const std::size_t pilots = std::min<std::size_t>(16, targets.size());
    std::vector<std::uint64_t> cost(pilots);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, pilots,
                        [&](std::size_t p) { cost[p] = measure(sampler, targets[p * targets.size() / pilots], 1).rays; });
    });
    std::uint64_t pilot_rays = 0;
    for (const auto c : cost) pilot_rays += c;
    out.rays += pilot_rays;
    const double per_pass = std::max(1.0, static_cast<double>(pilot_rays) / static_cast<double>(pilots));  // 16 samples of one organ
    const double passes = static_cast<double>(settings.rays > 0 ? settings.rays : rays_for(facets.size())) / per_pass;
    if (passes < static_cast<double>(chosen.size())) {
      chosen = draw(facets, solved, std::min<std::uint32_t>(settings.organs, std::max(64u, static_cast<std::uint32_t>(passes))), offset);
      targets = targets_of(facets, chosen);
    }
    const auto count = static_cast<std::uint32_t>(std::clamp(passes / static_cast<double>(chosen.size()), 1.0, 65536.0));
    measured.resize(chosen.size());
    constexpr std::size_t block = 16;  // organs between two questions whether to stop
    for (std::size_t first = 0; first < chosen.size(); first += block) {
      progress.check();
      progress.fraction("certificate", static_cast<double>(first) / static_cast<double>(chosen.size()));
      const std::size_t last = std::min(first + block, chosen.size());
      arena.execute([&] { tbb::parallel_for(first, last, [&](std::size_t k) { measured[k] = measure(sampler, targets[k], count); }); });
    }
    progress.fraction("certificate", 1.0);
  }

  for (const auto& c : chosen) out.organs.push_back(c.organ);
  for (std::size_t s = 0; s < solved.states; ++s)
    for (std::size_t k = 0; k < chosen.size(); ++k)
      for (std::size_t b = 0; b < solved.bands; ++b) {
        const double area = solved.area[chosen[k].organ];
        out.solved.push_back(static_cast<float>(solved.absorbed_power(s, chosen[k].organ, b)));
        out.reference.push_back(static_cast<float>(area * measured[k].absorbed[s * solved.bands + b]));
        out.standard_error.push_back(static_cast<float>(area * std::sqrt(measured[k].absorbed_variance[s * solved.bands + b])));
      }
  for (const auto& m : measured) out.rays += m.rays;
  for (std::size_t b = 0; b < solved.bands; ++b) {
    double leaves = 0.0, incident = 0.0;
    for (const auto& state : balance) leaves += state[b].leaves, incident += state[b].incident;
    estimate_band(b, facets, solved, chosen, measured, incident > 0.0 && leaves < least_absorbed * incident, out);
  }
  return out;
}

}  // namespace sunfleck
