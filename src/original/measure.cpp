#include <sunfleck/original/measure.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include <sunfleck/core/sampling.hpp>

#include "original/enforce.hpp"
#include "original/hull.hpp"
#include "original/octahedron.hpp"
#include "original/path_sums.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t replicates = 16;
constexpr std::uint32_t first_samples = 128;  ///< of each randomisation
constexpr std::uint32_t fit_samples = 256;

struct Mean {
  std::vector<double> value;
  double error = 0;     ///< standard error of the mean over the norm of the mean
  double variance = 0;  ///< sum of squared standard errors
};

/// Mean over randomisations of vectors that belong to them.
Mean mean_of(const std::vector<std::vector<double>>& all) {
  Mean m;
  m.value.assign(all[0].size(), 0.0);
  const auto count = static_cast<double>(all.size());
  double norm = 0;
  for (std::size_t i = 0; i < m.value.size(); ++i) {
    for (const auto& one : all) m.value[i] += one[i] / count;
    for (const auto& one : all) m.variance += (one[i] - m.value[i]) * (one[i] - m.value[i]) / (count * (count - 1.0));
    norm += m.value[i] * m.value[i];
  }
  m.error = norm > 0 ? std::sqrt(m.variance / norm) : 0.0;
  return m;
}

using Replicates = std::vector<PathSums>;

void sample(const PathMeasurement& measurement, Replicates& sums, std::uint32_t first, std::uint32_t count, std::uint64_t seed,
            const Progress& progress) {
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t r) { measurement.add(sums[r], first, count, mix(seed, r), progress); });
}

/// S of one randomisation and band as it would be stored, [n][n] [m^2 sr^-1].
std::vector<double> phase_of(const PathMeasurement& measurement, const PathSums& s, std::size_t band) {
  const std::size_t n = measurement.basis().size();
  const double scale = measurement.area() / static_cast<double>(s.samples), whole = std::sqrt(4.0 * std::numbers::pi);
  std::vector<double> phase(n * n);
  const double* sum = s.phase.data() + band * n * n;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) phase[i * n + j] = 0.5 * (sum[i * n + j] + sum[j * n + i]) * scale / std::numbers::pi;
  if (measurement.basis().harmonic())
    for (std::size_t i = 0; i < n; ++i) phase[i] = phase[i * n] = (s.intercepted[i] - s.absorbed[band * n + i]) * scale / whole;
  return phase;
}

Mean phase_mean(const PathMeasurement& measurement, const Replicates& sums, std::size_t band) {
  std::vector<std::vector<double>> all;
  for (const auto& s : sums) all.push_back(phase_of(measurement, s, band));
  return mean_of(all);
}

Mean sigma_mean(const PathMeasurement& measurement, const Replicates& sums) {
  std::vector<std::vector<double>> all;
  for (const auto& s : sums) {
    all.push_back(s.sigma);
    for (auto& v : all.back()) v *= measurement.area() / static_cast<double>(s.samples);
  }
  return mean_of(all);
}

/// Sums of all randomisations, divided.
void fill(const PathMeasurement& measurement, const Replicates& sums, OriginalTables& tables) {
  const std::size_t n = measurement.basis().size();
  std::uint64_t samples = 0;
  tables.intercepted.assign(n, 0.0);
  tables.absorbed.assign(tables.bands * n, 0.0);
  tables.phase.assign(tables.bands * n * n, 0.0);
  for (const auto& s : sums) {
    samples += s.samples;
    tables.rays += s.rays;
    for (std::size_t i = 0; i < n; ++i) tables.intercepted[i] += s.intercepted[i];
    for (std::size_t i = 0; i < s.absorbed.size(); ++i) tables.absorbed[i] += s.absorbed[i];
    for (std::size_t i = 0; i < s.phase.size(); ++i) tables.phase[i] += s.phase[i];
  }
  const double scale = measurement.area() / static_cast<double>(samples);
  for (auto& v : tables.intercepted) v *= scale;
  for (auto& v : tables.absorbed) v *= scale;
  for (auto& v : tables.phase) v *= scale / std::numbers::pi;
  tables.samples = samples;
  tables.sigma = sigma_mean(measurement, sums).value;
}

/// rms over pairs of 66 directions, none of which is a node of the table, of what S is beyond what the table shows.
void measure_fit(const OriginalGeometry& geometry, std::uint64_t seed, OriginalTables& tables, const Progress& progress) {
  const Mat3 turn =
      Mat3{Vec3{0.36, 0.48, -0.8}, Vec3{-0.8, 0.6, 0.0}, Vec3{0.48, 0.64, 0.6}};  // a rotation without symmetry to the octahedron
  MeasureBasis basis;
  for (const auto& d : octahedron().directions) basis.directions.push_back(glm::normalize(turn * d));
  const auto& weights = octahedron().weights;
  const PathMeasurement measurement(geometry, basis);
  Replicates sums(replicates, measurement.no_sums());
  sample(measurement, sums, 0, fit_samples, mix(seed, 77), progress);
  const std::size_t n = basis.size();
  for (const auto& s : sums) tables.rays += s.rays;
  for (std::uint32_t b = 0; b < tables.bands; ++b) {
    std::vector<std::vector<double>> all;
    for (const auto& s : sums) {
      all.push_back(phase_of(measurement, s, b));
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) all.back()[i * n + j] *= std::sqrt(weights[i] * weights[j]);
    }
    const Mean m = mean_of(all);
    double squared = 0, norm = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const double stored = tables.scattered(basis.directions[i], basis.directions[j], b) * std::sqrt(weights[i] * weights[j]);
        squared += (m.value[i * n + j] - stored) * (m.value[i * n + j] - stored);
        norm += stored * stored;
      }
    tables.errors[b].fit = norm > 0 ? std::sqrt(std::max(0.0, squared - m.variance) / norm) : 0.0;
  }
}

}  // namespace

OriginalTables measure_original(const OriginalGeometry& geometry, const MeasureSettings& settings, Progress& progress) {
  OriginalTables tables;
  tables.basis = settings.tables.basis;
  tables.order = tables.basis == TableSettings::Basis::harmonics ? settings.tables.order : 0;
  tables.bands = geometry.bands;
  tables.facets = geometry.corners.size();
  MeasureBasis basis;
  basis.order = tables.order;
  if (tables.basis == TableSettings::Basis::directions) basis.directions = octahedron().directions;
  const PathMeasurement measurement(geometry, basis);
  tables.area_m2 = measurement.area();
  tables.hull = convex_hull(geometry.corners);

  Replicates sums(replicates, measurement.no_sums());
  std::vector<double> sampling(geometry.bands);
  for (std::uint32_t done = 0, next = first_samples;; done += next, next = done) {
    sample(measurement, sums, done, next, settings.seed, progress);
    tables.sigma_error = sigma_mean(measurement, sums).error;
    double worst = tables.sigma_error;
    for (std::uint32_t b = 0; b < geometry.bands; ++b) {
      sampling[b] = phase_mean(measurement, sums, b).error;
      worst = std::max(worst, sampling[b]);
    }
    tables.reached = worst <= settings.tables.error;
    progress.fraction("original", std::min(1.0, settings.tables.error * settings.tables.error / (worst * worst + 1e-300)));
    if (tables.reached || (std::uint64_t{done} + next) * 2 * replicates > settings.most_samples) break;
  }
  fill(measurement, sums, tables);
  enforce_balance(tables);
  for (std::uint32_t b = 0; b < geometry.bands; ++b) tables.errors[b].sampling = sampling[b];
  if (settings.fit) measure_fit(geometry, settings.seed, tables, progress);
  return tables;
}

}  // namespace sunfleck
