// Radiosity: bands share one geometry, and stiff scenes are solved.
#include <catch2/catch.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Scene open_canopy(double leaf_area_index, const std::vector<double>& rho, const std::vector<double>& tau, const std::vector<double>& soil) {
  auto scene = scene_with(std::vector<std::string>(rho.size(), "w"), {uniform_optics("leaf", rho, tau)});
  for (std::size_t b = 0; b < rho.size(); ++b) scene.bands[b] += std::to_string(b);
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {4, 4}, soil);
  sky(scene, SkyModel::uniform, 100);
  point_sun(scene, {0.4, 0.1, 0.7}, 500);
  const double side = 0.1;
  add(scene, "canopy", leaves(static_cast<int>(leaf_area_index / (side * side)), side, {1, 1, 0.8}, 4), 0);
  return scene;
}

// Shares of what scatters.
constexpr double reflected = 0.55, transmitted = 0.45, soil_share = 0.6;

Scene albedo_scene(const std::vector<double>& albedos) {
  std::vector<double> rho, tau, soil;
  for (const double w : albedos) {
    rho.push_back(reflected * w);
    tau.push_back(transmitted * w);
    soil.push_back(soil_share * w);
  }
  return open_canopy(3, rho, tau, soil);
}

}  // namespace

TEST_CASE("radiosity: absorbed light as a series of scattering orders, the same in every band") {
  // With rho : tau : soil fixed, absorbed(w) = (1 - w) sum c_n w^n, where c_n >= 0 is what meets leaves for the n-th time. So
  // g(w) = absorbed(w) / (1 - w) and all its differences over even steps are positive.
  const std::vector<double> albedos = {0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95, 0.999};
  const auto scene = albedo_scene(albedos);
  for (const auto method : both_methods) {
    auto settings = settings_of(method, Quality::draft);
    settings.tolerance = 1e-6;
    const auto run = solve(scene, settings);
    CAPTURE(name_of(method));
    CHECK(run.report.status == SolveStatus::converged);
    std::vector<double> g;
    for (std::size_t b = 0; b < albedos.size(); ++b) {
      const auto& balance = run.report.balance[0][b];
      CHECK(std::abs(balance.residual()) <
            5e-3 * balance.incident);  // the sun's first reflection is counted by lines, whose areas are sampled
      g.push_back(balance.leaves / (1 - albedos[b]) / balance.incident);
    }
    std::vector<double> difference(g.begin(), g.end() - 1);
    for (int order = 0; order < 6; ++order) {
      for (const double d : difference) {
        CAPTURE(order, d);
        CHECK(d > 0);
      }
      for (std::size_t i = 0; i + 1 < difference.size(); ++i) difference[i] = difference[i + 1] - difference[i];
      difference.pop_back();
    }
    CHECK(g.back() > g[6]);
  }
}

TEST_CASE("radiosity: the coefficients of the series serve bands they were not taken from") {
  // g is a power series with falling coefficients: a polynomial through eight bands up to w = .5 gives g at other bands there to
  // w^8 c_8, below 1e-4 of it. Chebyshev points keep the interpolation's own error small.
  std::vector<double> albedos;
  constexpr int nodes = 8;
  for (int k = 0; k < nodes; ++k) albedos.push_back(0.25 - 0.25 * std::cos((k + 0.5) * std::numbers::pi / nodes));
  const std::vector<double> others = {0.1, 0.23, 0.37, 0.46};
  auto all = albedos;
  all.insert(all.end(), others.begin(), others.end());
  const auto scene = albedo_scene(all);
  for (const auto method : both_methods) {
    auto settings = settings_of(method, Quality::draft);
    settings.tolerance = 1e-6;
    const auto run = solve(scene, settings);
    CAPTURE(name_of(method));
    std::vector<std::vector<double>> g;
    for (std::size_t b = 0; b < all.size(); ++b) {
      g.push_back(organ_power(run, b));
      g.back().resize(run.facets.organs.size() - 16);  // leaves only
      for (auto& x : g.back()) x /= 1 - all[b];
    }
    for (std::size_t o = 0; o < others.size(); ++o) {
      const double w = others[o];
      std::vector<double> predicted(g[0].size(), 0.0);
      for (int k = 0; k < nodes; ++k) {
        double lagrange = 1;
        for (int j = 0; j < nodes; ++j)
          if (j != k) lagrange *= (w - albedos[j]) / (albedos[k] - albedos[j]);
        for (std::size_t i = 0; i < predicted.size(); ++i) predicted[i] += lagrange * g[static_cast<std::size_t>(k)][i];
      }
      CAPTURE(w);
      CHECK(relative_rms(predicted, g[nodes + o]) < 1e-5);
    }
  }
}

TEST_CASE("radiosity: many bands at once give what single bands give") {
  const std::vector<double> albedos = {0.1, 0.5, 0.9, 0.99};
  for (const auto method : both_methods) {
    auto settings = settings_of(method, Quality::draft);
    settings.tolerance = 1e-6;
    const auto together = solve(albedo_scene(albedos), settings);
    for (std::size_t b = 0; b < albedos.size(); ++b) {
      // far links of method clustering are chosen by the largest albedo of any band: keep that one in the scene
      const auto alone = method == RadiosityMethod::flat ? solve(albedo_scene({albedos[b]}), settings)
                                                         : solve(albedo_scene({albedos[b], albedos.back()}), settings);
      CAPTURE(name_of(method), albedos[b], relative_rms(organ_power(together, b), organ_power(alone)));
      // the residual of each is 1e-6 of the light that comes in; the error is up to 1 / (1 - w) times as large
      CHECK(relative_rms(organ_power(together, b), organ_power(alone)) < 2e-6 / (1 - albedos[b]) + 1e-6);
    }
  }
}

TEST_CASE("radiosity: stiff scenes need few applications of the operator") {
  // LAI 8, leaf albedo up to .999; plain iteration needs hundreds to thousands. Measured: 11 at .9, 12 to 16 at .99 and .999 (20 and
  // 26 to 32 before one half of the lines was eliminated).
  std::size_t most = 0;
  for (const auto method : both_methods)
    for (const double soil : {0.0, 0.2, 1.0})
      for (const double w : {0.9, 0.99, 0.999}) {
        auto settings = settings_of(method, Quality::draft);
        settings.tolerance = 1e-6;
        const auto run = solve(open_canopy(8, {0.5 * w}, {0.5 * w}, {soil}), settings);
        CAPTURE(name_of(method), soil, w, run.report.convergence.size(), run.report.convergence.back().residual);
        CHECK(run.report.status == SolveStatus::converged);
        CHECK(run.report.convergence.back().residual <= 1e-6);
        CHECK(run.report.convergence.size() <= (w < 0.95 ? 14u : 20u));
        most = std::max(most, run.report.convergence.size());
      }
  CHECK(most > 5);
}
