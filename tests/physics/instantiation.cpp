// Light in copies that share an original: against the flat solution, closed forms, and itself.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Run instantiated(const Scene& scene, Quality quality = Quality::standard, int threads = 0, Progress& progress = silent()) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(quality);
  settings.threads = threads;
  auto report = solve_instantiation(scene, place(scene), settings, kept, progress);
  return {std::move(facets), std::move(kept), std::move(report)};
}

/// Copies of one crown of 150 leaves, about 1 m wide: as they grow, on a slope, turned, mirrored and scaled.
std::vector<Placement> stances(double spacing) {
  std::vector<Placement> out;
  for (int i = 0; i < 4; ++i) {
    Stance s;
    s.position = {spacing * (i % 2), spacing * (i / 2), 0.05 * i};
    s.turn_deg = 80.0 * i;
    s.mirror = i == 1;
    s.scale = i == 2 ? 1.2 : 1.0;
    s.tilt_deg = i == 3 ? 15 : 0;
    out.push_back(placed(s));
  }
  return out;
}

Scene crowns(std::vector<Placement> places, const std::vector<Optics>& optics, const std::vector<double>& soil) {
  auto scene = scene_with({"PAR", "NIR"}, optics);
  scene.ground = flat_ground({6, 6}, {1, 1}, {12, 12}, soil);
  add(scene, "crown", leaves(150, 0.12, {1, 1, 1}, 3), 0);
  scene.plants[0].placements = std::move(places);
  return scene;
}

std::vector<Optics> green() {
  return {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})};
}

void light(Scene& scene) {
  sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
}

}  // namespace

TEST_CASE("instantiation: turned, mirrored, scaled and tilted copies are lit as the flat method lights them") {
  auto scene = crowns(stances(1.6), green(), {0.12, 0.2});
  light(scene);
  const auto copies = instantiated(scene);
  CHECK(copies.report.status == SolveStatus::converged);
  const auto flat = solve(scene, RadiosityMethod::clustering, Quality::fine);
  // both sample; organs are few and large here: about 1 % each in the flat solution's own fine quality
  for (std::size_t band = 0; band < 2; ++band) {
    auto a = organ_power(copies, band), b = organ_power(flat, band);
    a.resize(600), b.resize(600);  // leaves only
    CAPTURE(band, relative_rms(a, b));
    CHECK(relative_rms(a, b) < (band == 0 ? 0.015 : 0.022));
    double sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum_a += a[i], sum_b += b[i];
    CHECK(sum_a == Approx(sum_b).epsilon(0.004));
    const auto& balance = copies.report.balance[0][band];
    CHECK(std::abs(balance.residual()) < 5e-3 * balance.incident);
  }
}

TEST_CASE("instantiation: white leaves over white ground under an even sky are lit by 1 on every side") {
  auto scene = crowns(stances(1.1), {{"leaf", {0.7f, 0.5f}, {0.7f, 0.5f}, {0.3f, 0.5f}}}, {1, 1});
  scene.periodic = PeriodicCell{-2, -2, 4, 4};
  sky(scene, SkyModel::uniform, 1);
  scene.ground = flat_ground({6, 6}, {1, 1}, {6, 6}, {1, 1});
  const auto run = instantiated(scene, Quality::fine);
  CHECK(run.report.status == SolveStatus::converged);
  double worst = 0;
  for (std::size_t f = 0; f < run.facets.size(); ++f)
    for (int side = 0; side < (f < run.facets.plant_facets ? 2 : 1); ++side)
      for (std::size_t b = 0; b < 2; ++b) worst = std::max(worst, std::abs(run.kept.on(f, side, b) - 1));
  CAPTURE(worst);
  CHECK(worst < 5e-3);  // rows sum to 1 exactly: what is left is the tolerance of the two nested iterations
}

TEST_CASE("instantiation: copies that reach into each other are solved as one") {
  std::vector<Placement> places(2);
  places[1].map = Affine::translate({0.5, 0, 0}) * Affine::turn(1);
  auto scene = crowns(places, green(), {0.12, 0.2});
  light(scene);
  const auto copies = instantiated(scene);
  std::uint64_t merged = 0;
  for (const auto& [name, n] : copies.report.counts)
    if (name == "merged_copies") merged = n;
  CHECK(merged == 2);
  const auto flat = solve(scene, RadiosityMethod::clustering, Quality::fine);
  for (std::size_t band = 0; band < 2; ++band) {
    auto a = organ_power(copies, band), b = organ_power(flat, band);
    a.resize(300), b.resize(300);
    CAPTURE(band, relative_rms(a, b));
    CHECK(relative_rms(a, b) < (band == 0 ? 0.015 : 0.022));
  }
}

TEST_CASE("instantiation: says so where copies reach into each other across the border of the cell, which cannot be solved as one") {
  class Heard final : public Progress {
   public:
    void line(std::string_view text) override { said += std::string(text) + "\n"; }
    std::string said;
  };
  const auto said_in_cell_of = [](double size) {
    auto scene = crowns({Placement{}}, green(), {0.12, 0.2});
    scene.periodic = PeriodicCell{0, 0, size, size};
    scene.ground = flat_ground({size, size}, {size / 2, size / 2}, {2, 2}, {0.12, 0.2});
    light(scene);
    Heard progress;
    instantiated(scene, Quality::draft, 0, progress);
    return progress.said;
  };
  const std::string note = "% of what is seen inside copies is hidden by others that reach into them, or by images of their own";
  CHECK(said_in_cell_of(0.7).find(note) != std::string::npos);
  CHECK(said_in_cell_of(1.4).find(note) == std::string::npos);
}

TEST_CASE("instantiation: one plant in a small cell is lit as nine in a cell of three by three") {
  auto one = crowns({Placement{}}, green(), {0.12, 0.2});
  one.periodic = PeriodicCell{-0.1, -0.1, 1.2, 1.2};
  one.ground = flat_ground({1.3, 1.3}, {0.55, 0.55}, {2, 2}, {0.12, 0.2});
  light(one);
  std::vector<Placement> places;
  for (int i = 0; i < 9; ++i) places.push_back({Affine::translate({1.3 * (i % 3), 1.3 * (i / 3), 0})});
  auto nine = crowns(places, green(), {0.12, 0.2});
  nine.periodic = PeriodicCell{-0.1, -0.1, 3.8, 3.8};
  nine.ground = flat_ground({3.9, 3.9}, {1.85, 1.85}, {6, 6}, {0.12, 0.2});
  light(nine);
  const auto a = instantiated(one), b = instantiated(nine);
  for (std::size_t band = 0; band < 2; ++band) {
    auto x = organ_power(a, band), all = organ_power(b, band);
    std::vector<double> y(all.begin() + 4 * 150, all.begin() + 5 * 150);  // the middle one
    x.resize(150);
    CAPTURE(band, relative_rms(x, y));
    CHECK(relative_rms(x, y) < 0.01);  // the same lines inside; rays between copies and the sun's grid differ
  }
}

TEST_CASE("instantiation: the same bits for any number of threads") {
  auto scene = crowns(stances(1.3), green(), {0.12, 0.2});
  light(scene);
  const auto a = instantiated(scene, Quality::draft, 1), b = instantiated(scene, Quality::draft, 2);
  for (std::size_t f = 0; f < a.facets.size(); ++f)
    for (int side = 0; side < 2; ++side)
      for (std::size_t band = 0; band < 2; ++band) REQUIRE(a.kept.on(f, side, band) == b.kept.on(f, side, band));
}

TEST_CASE("instantiation: a stretched copy has an original of its own, and states share what does not depend on the light") {
  std::vector<Placement> places(2);
  places[1].map = {Mat3{1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.4}, Vec3{2, 0, 0}};
  auto scene = crowns(places, green(), {0.12, 0.2});
  light(scene);
  const auto one = instantiated(scene, Quality::draft);
  CHECK(one.report.counts.front() == std::pair<std::string, std::uint64_t>{"originals", 2});
  scene.states.push_back(scene.states[0]);
  scene.states[1].sun.reset();
  const auto two = instantiated(scene, Quality::draft);
  for (std::size_t f = 0; f < one.facets.plant_facets; f += 7)  // the first state is as it was alone, within the iteration's tolerance
    CHECK(two.kept.on(f, 0, 1, 0) == Approx(one.kept.on(f, 0, 1)).epsilon(0.01));
}
