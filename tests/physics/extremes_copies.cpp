// Extremes of copies that are solved through their original: size, place, copies in copies, borders of a cell.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"
#include "reference_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Run instantiated(const Scene& scene, Quality quality = Quality::draft) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  InstantiationSettings settings;
  settings.density = instantiation_density(quality);
  auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

constexpr std::size_t crown_leaves = 60;

/// Copies of one crown of 60 leaves, about 1 m wide, over ground; all lengths times `scale`, all places moved by `offset`.
Scene crowns(const std::vector<Vec3>& places, double scale = 1, const Vec3& offset = {0, 0, 0}) {
  auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
  sky(scene, SkyModel::standard_overcast, 100);
  point_sun(scene, {0.5, 0.1, 0.7}, 400);
  scene.ground = flat_ground({6 * scale, 6 * scale}, {scale + offset.x, scale + offset.y}, {6, 6}, {0.1, 0.2});
  scene.ground->height = offset.z;
  add(scene, "crown", leaves(crown_leaves, 0.25, {1, 1, 1}, 21), 0);
  scene.plants[0].placements.clear();
  for (const auto& p : places) scene.plants[0].placements.push_back({Affine::translate(scale * p + offset) * Affine::scale(scale)});
  return scene;
}
const std::vector<Vec3> four{{0, 0, 0}, {1.6, 0, 0}, {0, 1.6, 0.1}, {1.6, 1.6, 0}};

/// Of leaves only [W].
std::vector<double> leaf_power(const Run& run, std::size_t copies, std::size_t band) {
  auto power = organ_power(run, band);
  power.resize(copies * crown_leaves);
  return power;
}

void check_sound(const Run& run, double most_residual = 1e-2) {
  CHECK(run.report.status == SolveStatus::converged);
  CHECK(run.kept.complete());
  std::size_t broken = 0;
  for (const float e : run.kept.irradiance) broken += !(e >= 0 && std::isfinite(e));
  CHECK(broken == 0);
  for (const auto& b : run.report.balance[0]) {
    CAPTURE(b.incident, b.leaves, b.ground, b.escaped);
    CHECK(std::abs(b.residual()) <= most_residual * b.incident);
  }
}

}  // namespace

TEST_CASE("extremes of copies: scales of a millionth and a million", "[extremes]") {
  const auto as_is = instantiated(crowns(four));
  for (const double scale : {1e-6, 1e6}) {
    CAPTURE(scale);
    const auto run = instantiated(crowns(four, scale));
    check_sound(run);
    for (std::size_t band = 0; band < 2; ++band) {
      auto p = leaf_power(run, 4, band);
      for (auto& x : p) x /= scale * scale;
      CHECK(relative_rms(p, leaf_power(as_is, 4, band)) < 5e-3);  // rounding moves a few lines and rays across edges
    }
  }
}

TEST_CASE("extremes of copies: ten thousand kilometres away", "[extremes]") {
  // Placements are in double precision: at 1e7 m exact to 2e-9 m. What changes is where the sun's grid falls, as after any move.
  const auto here = instantiated(crowns(four)), near = instantiated(crowns(four, 1, {0.37, -0.21, 0.5})),
             there = instantiated(crowns(four, 1, {1e7, -1e7, 5000}));
  check_sound(there);
  for (std::size_t band = 0; band < 2; ++band) {
    const auto reference = leaf_power(here, 4, band);
    const double after_any_move = relative_rms(leaf_power(near, 4, band), reference);
    CAPTURE(band, after_any_move);
    CHECK(after_any_move < 0.03);  // the accuracy of draft
    CHECK(relative_rms(leaf_power(there, 4, band), reference) < 1.5 * after_any_move);
  }
}

TEST_CASE("extremes of copies: a copy exactly on another", "[extremes]") {
  // Whichever lies above, the two together keep what two with a gap of a millionth keep.
  const auto on = instantiated(crowns({{0, 0, 0}, {0, 0, 0}, {2, 0, 0}}), Quality::standard);
  const auto with_gap = crowns({{0, 0, 0}, {0, 0, 1e-5}, {2, 0, 0}});
  const auto apart = solve(with_gap, RadiosityMethod::clustering, Quality::standard);
  const auto traced = reference_runs::trace(with_gap, 512);
  check_sound(on);
  CHECK(on.report.counts.at(2) == std::pair<std::string, std::uint64_t>{"merged_copies", 2});
  for (std::size_t band = 0; band < 2; ++band) {
    double together = 0, clusters = 0, paths = 0;
    for (const double p : leaf_power(on, 3, band)) together += p;
    for (const double p : leaf_power(apart, 3, band)) clusters += p;
    for (std::size_t f = 0; f < traced.facets.plant_facets; ++f) paths += traced.facets.area[f] * traced.absorbed(f, band);
    CAPTURE(band, together, clusters, paths);
    CHECK(clusters == Approx(paths).epsilon(0.015));
    // leaves that mostly hide each other, a few lines of an original in the gap: +2.9 % in PAR measured
    CHECK(together == Approx(paths).epsilon(0.035));
  }
}

TEST_CASE("extremes of copies: across the border of the cell, and a thousand cells away", "[extremes]") {
  const auto in_cell = [](const Vec3& moved) {
    auto scene = crowns({moved + Vec3{0, 0, 0}, moved + Vec3{1.5, 0, 0}});
    scene.periodic = PeriodicCell{-0.25, -0.25, 2.75, 1.25};
    scene.ground = flat_ground({3, 1.5}, {1.25, 0.5}, {4, 2}, {0.1, 0.2});
    return scene;
  };
  const auto inside = instantiated(in_cell({0, 0, 0}));
  check_sound(inside);
  for (const Vec3& moved : {Vec3{0.9, 0, 0}, Vec3{0, 0.8, 0}, Vec3{3000, -1500, 0}}) {
    CAPTURE(moved.x, moved.y);
    const auto run = instantiated(in_cell(moved));
    check_sound(run);
    // the ground's facets and the sun's grid stand elsewhere under the plants: the accuracy of draft
    for (std::size_t band = 0; band < 2; ++band) CHECK(relative_rms(leaf_power(run, 2, band), leaf_power(inside, 2, band)) < 0.03);
  }
}

TEST_CASE("extremes of copies: one copy, and a scene of copies without area", "[extremes]") {
  const auto one = crowns({{0, 0, 0}});
  const auto alone = instantiated(one, Quality::standard), flat = solve(one, RadiosityMethod::clustering, Quality::standard);
  check_sound(alone);
  for (std::size_t band = 0; band < 2; ++band) CHECK(relative_rms(leaf_power(alone, 1, band), leaf_power(flat, 1, band)) < 0.03);
  auto none = crowns(four);
  none.plants[0].plant = std::make_shared<const Plant>(make_plant(Mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, "line"));
  none.plants[0].shape_optics.resize(1);
  const auto rows = instantiated(none);
  for (std::size_t f = 0; f < rows.facets.plant_facets; ++f) CHECK(rows.kept.on(f, 0) == 0);
  CHECK(rows.report.balance[0][0].ground == Approx(0.9 * rows.report.balance[0][0].incident).epsilon(2e-3));
}
