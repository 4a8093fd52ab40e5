// Small scenes solved by the radiosity methods, with what the tests of closed forms ask of the answer.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <sunfleck/radiosity/solve.hpp>

#include "reference_runs.hpp"

namespace radiosity_runs {

using namespace sunfleck;
using reference_runs::add;
using reference_runs::Kept;
using reference_runs::leaves;
using reference_runs::point_sun;
using reference_runs::Run;
using reference_runs::scene_with;
using reference_runs::sky;
using reference_runs::square;

inline RadiositySettings settings_of(RadiosityMethod method, Quality quality = Quality::standard, std::uint64_t seed = 1) {
  RadiositySettings s;
  s.method = method;
  s.density = density_of(quality);
  s.seed = seed;
  return s;
}

inline Run solve(const Scene& scene, const RadiositySettings& settings) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  auto report = solve_radiosity(scene, facets, settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}
inline Run solve(const Scene& scene, RadiosityMethod method, Quality quality = Quality::standard, std::uint64_t seed = 1) {
  return solve(scene, settings_of(method, quality, seed));
}

inline const char* name_of(RadiosityMethod method) {
  return method == RadiosityMethod::flat ? "flat" : "clustering";
}
inline constexpr RadiosityMethod both_methods[] = {RadiosityMethod::clustering, RadiosityMethod::flat};

/// Absorbed power of each organ in a band and state [W].
inline std::vector<double> organ_power(const Run& run, std::size_t band = 0, std::size_t state = 0) {
  std::vector<double> power(run.facets.organs.size(), 0.0);
  for (std::size_t f = 0; f < run.facets.size(); ++f) power[run.facets.organ[f]] += run.facets.area[f] * run.absorbed(f, band, state);
  return power;
}

/// Root of the mean squared difference over the mean of the second.
inline double relative_rms(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0, mean = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += (a[i] - b[i]) * (a[i] - b[i]);
    mean += b[i];
  }
  return std::sqrt(square / static_cast<double>(a.size())) / (mean / static_cast<double>(a.size()));
}

}  // namespace radiosity_runs
