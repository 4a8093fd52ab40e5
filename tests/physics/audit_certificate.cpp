// The certificate against errors that we made ourselves.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <sunfleck/audit/certificate.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

Scene canopy(const std::vector<double>& reflectance, const std::vector<double>& transmittance) {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", reflectance, transmittance)});
  scene.ground = flat_ground({2, 2}, {0.5, 0.5}, {2, 2}, {0.1, 0.2});
  point_sun(scene, {0.3, 0.2, 0.8}, 400);
  sky(scene, SkyModel::standard_overcast, 90);
  auto shapes = leaves(150, 0.12, {1, 1, 0.5}, 9);
  for (std::size_t i = 0; i < shapes.size(); i += 15)  // some organs are much larger than others
    for (auto& p : shapes[i].vertices) p = shapes[i].vertices[0] + 3.0 * (p - shapes[i].vertices[0]);
  add(scene, "canopy", shapes, 0);
  return scene;
}

/// What a solver would hand over, from the reference method: sums of all organs.
OrganTotals totals_of(const Run& run) {
  const std::size_t m = run.facets.organs.size();
  std::vector<std::uint64_t> all(m);
  std::iota(all.begin(), all.end(), 0u);
  OrganTotals t(1, 2, std::move(all));
  for (std::size_t f = 0; f < run.facets.size(); ++f) {
    const std::size_t o = run.facets.organ[f];
    const double a = run.facets.area[f];
    t.area[o] += a;
    for (std::size_t b = 0; b < 2; ++b) {
      t.absorbed[o * 2 + b] += a * run.absorbed(f, b);
      for (int side = 0; side < 2; ++side) t.irradiance[(o * 2 + static_cast<std::size_t>(side)) * 2 + b] += a * run.kept.on(f, side, b);
    }
  }
  return t;
}

/// Organs are chosen, their light is looked up among all, and they are checked.
Certificate check(const Scene& scene, const Run& run, const OrganTotals& all, const CertificateSettings& settings) {
  const PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  const auto chosen = choose_organs(rows, settings);
  std::vector<std::uint64_t> organs;
  for (const auto& c : chosen) organs.push_back(c.organ);
  OrganTotals some(1, 2, organs);
  for (std::size_t k = 0; k < organs.size(); ++k) {
    const std::size_t o = organs[k];
    some.area[k] = all.area[o];
    for (std::size_t i = 0; i < 2; ++i) some.absorbed[k * 2 + i] = all.absorbed[o * 2 + i];
    for (std::size_t i = 0; i < 4; ++i) some.irradiance[k * 4 + i] = all.irradiance[o * 4 + i];
  }
  for (std::size_t o = 0; o < all.organs.size(); ++o) {
    if (run.facets.organs.structure[o] == no_parent) continue;
    some.plant_area += all.area[o];
    for (std::size_t b = 0; b < 2; ++b) {
      some.plant_absorbed[b] += all.absorbed[o * 2 + b];
      some.plant_irradiance[b] += all.irradiance[o * 4 + b] + all.irradiance[o * 4 + 2 + b];
    }
  }
  return certify(scene, rows, RayScene(run.facets), chosen, some, run.report.balance, settings, silent());
}

}  // namespace

TEST_CASE("certificate: the interval holds the error that was made, with any seed") {
  const auto scene = canopy({0.08, 0.45}, {0.04, 0.40});
  const auto run = trace(scene, 1024);
  const auto truth = totals_of(run);
  auto wrong = truth;
  RandomStream random(5);
  double area = 0, light[2] = {}, square[2] = {}, bias[2] = {};
  const std::size_t m = truth.organs.size();
  for (std::size_t o = 0; o < m; ++o) {
    if (run.facets.organs.structure[o] == no_parent) continue;
    area += truth.area[o];
    for (std::size_t b = 0; b < 2; ++b) {
      const double e = 0.03 + 0.2 * (random.next() - 0.5);
      auto& x = wrong.absorbed[o * 2 + b];
      light[b] += x;
      bias[b] += e * x;
      square[b] += e * e * x * x / truth.area[o];
      x *= 1 + e;
    }
  }
  int inside = 0, unbiased = 0;
  constexpr int runs = 12;
  for (int r = 0; r < runs; ++r) {
    CertificateSettings settings;
    settings.seed = 50 + r;
    settings.organs = 70;
    settings.rays = 30000;
    const auto c = check(scene, run, wrong, settings);
    CHECK(c.organs.size() >= 69);
    CHECK(c.organs.size() <= 71);
    CHECK(c.solved.size() == 2 * c.organs.size());
    CHECK(c.rays < 45000);
    for (std::size_t b = 0; b < 2; ++b) {
      const double rmse = std::sqrt(square[b] / area) / (light[b] / area);
      inside += c.rmse_low[b] <= rmse && rmse <= c.rmse_high[b];
      unbiased += std::abs(c.bias[b] - bias[b] / light[b]) < 2.5 * c.bias_standard_error[b];
      CHECK(c.rmse_low[b] <= c.rmse[b]);
      CHECK(c.rmse[b] <= c.rmse_high[b]);
    }
  }
  CHECK(inside >= 2 * runs - 3);
  CHECK(unbiased >= 2 * runs - 3);
}

TEST_CASE("certificate: the same for any number of threads; large organs and small scenes are taken for sure") {
  const auto scene = canopy({0.08, 0.45}, {0.04, 0.40});
  const auto run = trace(scene, 16);
  const auto totals = totals_of(run);
  CertificateSettings settings;
  settings.rays = 60000;
  settings.threads = 1;
  const auto one = check(scene, run, totals, settings);
  settings.threads = 2;
  const auto two = check(scene, run, totals, settings);
  CHECK(one.organs.size() == 150);  // all: the scene has no more
  CHECK(one.reference == two.reference);
  CHECK(one.rmse == two.rmse);
  CHECK(one.rays == two.rays);
  settings.organs = 96;
  const auto some = check(scene, run, totals, settings);
  for (std::uint32_t large = 0; large < 150; large += 15) CHECK(std::count(some.organs.begin(), some.organs.end(), large) == 1);
  CHECK(std::is_sorted(some.organs.begin(), some.organs.end()));
}

TEST_CASE("certificate: where nothing is absorbed, irradiance is checked") {
  const auto scene = canopy({0.5, 0.5}, {0.5, 0.5});
  const auto run = trace(scene, 64);
  auto totals = totals_of(run);
  for (auto& e : totals.irradiance) e *= 1.1;
  CertificateSettings settings;
  settings.rays = 60000;
  const auto c = check(scene, run, totals, settings);
  for (std::size_t b = 0; b < 2; ++b) {
    CHECK(c.bias[b] == Approx(0.1).margin(0.03));
    CHECK(c.rmse[b] == Approx(0.13).margin(0.06));
  }
}

TEST_CASE("certificate: a scene of ground alone has nothing to check") {
  auto scene = scene_with({"PAR", "NIR"}, {});
  scene.ground = flat_ground({2, 2}, {0, 0}, {2, 2}, {0.1, 0.2});
  sky(scene, SkyModel::uniform, 1);
  const auto run = trace(scene, 16);
  const auto c = check(scene, run, totals_of(run), {});
  CHECK(c.organs.empty());
  CHECK(c.rmse == std::vector<double>{0, 0});
}

TEST_CASE("certificate: through copies it finds what it finds through facets") {
  auto scene = canopy({0.08, 0.45}, {0.04, 0.40});
  Stance mirrored;
  mirrored.position = {1.1, 0.2, 0.1};
  mirrored.turn_deg = 50;
  mirrored.mirror = true;
  scene.plants[0].placements.push_back(placed(mirrored));
  const auto run = trace(scene, 64);
  const PlacedScene copies = place(scene);
  const FacetRows rows(scene, copies);
  CertificateSettings settings;
  settings.organs = 300;
  settings.rays = 2000000;
  const auto chosen = choose_organs(rows, settings);
  REQUIRE(chosen.size() == 300);  // all
  OrganTotals none(1, 2, {});
  for (const auto& c : chosen) none.organs.push_back(c.organ);
  none = OrganTotals(1, 2, none.organs);
  none.area.assign(300, 1.0);
  const auto flat = certify(scene, rows, RayScene(run.facets), chosen, none, run.report.balance, settings, silent());
  const auto placed_too = certify(scene, rows, RayScene(rows), chosen, none, run.report.balance, settings, silent());
  // The same random numbers: paths part only where rounding does, at most a few per cent of them.
  double difference = 0, noise = 0;
  for (std::size_t i = 0; i < flat.reference.size(); ++i) {
    difference += std::pow(flat.reference[i] - placed_too.reference[i], 2);
    noise += std::pow(flat.standard_error[i], 2);
  }
  CHECK(difference < 0.1 * noise);
}

TEST_CASE("reference: through copies it gives what it gives through facets") {
  auto scene = canopy({0.08, 0.45}, {0.04, 0.40});
  scene.plants[0].placements.push_back(placed({{0.3, 0.7, 0.2}, 50}));
  const auto run = trace(scene, 64);
  const PlacedScene copies = place(scene);
  const FacetRows rows(scene, copies);
  Kept kept(1, run.facets.size(), 2);
  ReferenceSettings settings;
  settings.samples = 64;
  const auto report = trace_reference(scene, rows, settings, kept, silent());
  CHECK(kept.complete());
  double difference = 0, noise = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f) {
    difference += std::pow(kept.on(f, 0, 1) - run.kept.on(f, 0, 1), 2);
    noise += kept.variance_of(f, 1);
  }
  CHECK(difference < 0.3 * noise);
  CHECK(report.balance[0][1].leaves == Approx(run.report.balance[0][1].leaves).epsilon(2e-3));
}
