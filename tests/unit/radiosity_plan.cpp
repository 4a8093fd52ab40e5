#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <sunfleck/radiosity/plan.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;

namespace {

/// Leaves of two triangles, one organ each, at random in a cube of 1 m, over ground.
Scene canopy(bool periodic, int leaves, bool sun, bool sky) {
  Scene scene = reference_runs::scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.1, 0.45}, {0.05, 0.4})});
  reference_runs::add(scene, "plant", reference_runs::leaves(leaves, 0.08, {1, 1, 1}, 7), 0);
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {10, 10}, {0.1, 0.2});
  if (periodic) scene.periodic = PeriodicCell{0, 0, 1, 1};
  if (sun) reference_runs::point_sun(scene, {0.3, 0.2, 0.9}, 400);
  if (sky) reference_runs::sky(scene, SkyModel::standard_overcast, 100);
  return scene;
}

struct NoSink : IrradianceSink {
  void rows(const IrradianceRows&) override {}
};

using Figures = std::vector<std::pair<std::string, std::uint64_t>>;

std::uint64_t figure(const Figures& figures, const std::string& name) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const auto& f) { return f.first == name; });
  REQUIRE(found != figures.end());
  return found->second;
}

/// Approximately the figure that a solve reports.
Approx about(std::uint64_t reported, double tolerance) {
  return Approx(static_cast<double>(reported)).epsilon(tolerance);
}

void check_prediction(const Scene& scene, RadiositySettings settings) {
  const FacetScene facets = expand(scene);
  const RadiosityPlan plan = plan_radiosity(scene, facets, settings, silent());
  NoSink sink;
  const SolveReport report = solve_radiosity(scene, facets, settings, sink, silent());
  CHECK(plan.elements == figure(report.counts, "elements"));
  CHECK(plan.cells == figure(report.counts, "cells"));
  CHECK(figure(plan.memory, "elements") == figure(report.memory, "elements"));
  CHECK(figure(plan.memory, "direct") == figure(report.memory, "direct"));
  // the expected number of meetings is exact; grids of a periodic cell are rounded to whole lines, about 1 % of so few
  CHECK(static_cast<double>(plan.sky_fragments + plan.sun_fragments) == about(figure(report.counts, "direct_fragments"), 0.02));
  if (settings.method == RadiosityMethod::direct) {
    CHECK(plan.line_fragments == 0);
    CHECK(plan.links == 0);
    return;
  }
  // a solve that meets few far lines in its first batch does without clusters; near that threshold the pilot may choose otherwise
  const auto clusters = figure(report.counts, "clusters");
  const bool same_choice = plan.clusters == clusters;
  CHECK((same_choice || plan.clusters == 0 || clusters == 0));
  CHECK((same_choice || settings.method != RadiosityMethod::flat));
  // a pilot of 16 directions stands for all: a few per cent of what they meet
  CHECK(static_cast<double>(plan.line_fragments) == about(figure(report.counts, "fragments"), 0.1));
  CHECK(static_cast<double>(plan.links) == about(figure(report.counts, "links"), 0.25));
  if (same_choice) {
    CHECK(static_cast<double>(figure(plan.memory, "links")) == about(figure(report.memory, "links"), 0.25));
    // the iteration keeps a field for each step that it takes, which optics decide
    CHECK(static_cast<double>(figure(plan.memory, "fields")) == about(figure(report.memory, "fields"), 0.35));
    std::uint64_t planned = 0, held = 0;
    for (const char* part : {"elements", "direct", "links", "fields"})
      planned += figure(plan.memory, part), held += figure(report.memory, part);
    CHECK(static_cast<double>(planned) == about(held, 0.25));
  }
  CHECK(figure(plan.memory, "lines") > 0);
}

}  // namespace

TEST_CASE("a plan predicts what a solve takes", "[radiosity][plan]") {
  RadiositySettings settings;
  SECTION("periodic, sun and sky") {
    check_prediction(canopy(true, 400, true, true), settings);
  }
  SECTION("finite, sun and sky") {
    check_prediction(canopy(false, 400, true, true), settings);
  }
  SECTION("sun alone") {
    check_prediction(canopy(true, 200, true, false), settings);
  }
  SECTION("sky alone, draft") {
    settings.density = density_of(Quality::draft);
    check_prediction(canopy(true, 200, false, true), settings);
  }
  SECTION("flat") {
    settings.method = RadiosityMethod::flat;
    check_prediction(canopy(true, 200, true, true), settings);
  }
  SECTION("direct") {
    settings.method = RadiosityMethod::direct;
    check_prediction(canopy(false, 200, true, true), settings);
  }
}
