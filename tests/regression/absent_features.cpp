// What a scene does not have leaves out its memory and its work, by the program's own counts.
#include <catch2/catch.hpp>

#include <map>

#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/radiosity/plan.hpp>

#include <sunfleck/solver/method_choice.hpp>
#include "radiosity/transport.hpp"
#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

/// A canopy with all there is: sun, overcast sky, two bands, transmission, a period, ground.
Scene full_scene() {
  auto scene = scene_with({"PAR", "NIR"}, {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0.04f, 0.40f}}});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {6, 6}, {0.1, 0.2});
  sky(scene, SkyModel::standard_overcast, 100);
  point_sun(scene, {0.5, 0.1, 0.7}, 400);
  add(scene, "canopy", leaves(120, 0.15, {1, 1, 0.8}, 4), 0);
  return scene;
}

struct Counted {
  std::map<std::string, std::uint64_t> work, bytes, planned_bytes;
  std::uint64_t planned_sky = 0, planned_sun = 0, planned_lines = 0, planned_links = 0;
  std::size_t applications = 0;
  std::map<std::string, double> seconds;
};

Counted counted(const Scene& scene, RadiosityMethod method = RadiosityMethod::flat) {
  Counted out;
  const auto settings = settings_of(method, Quality::draft);
  const auto run = solve(scene, settings);
  out.work.insert(run.report.counts.begin(), run.report.counts.end());
  out.bytes.insert(run.report.memory.begin(), run.report.memory.end());
  out.applications = run.report.convergence.size();
  out.seconds.insert(run.report.timings.begin(), run.report.timings.end());
  const auto plan = plan_radiosity(scene, run.facets, settings, silent());
  out.planned_bytes.insert(plan.memory.begin(), plan.memory.end());
  out.planned_sky = plan.sky_fragments, out.planned_sun = plan.sun_fragments;
  out.planned_lines = plan.line_fragments, out.planned_links = plan.links;
  return out;
}

}  // namespace

TEST_CASE("absent: sun and sky", "[absent]") {
  auto no_sun = full_scene(), no_sky = full_scene();
  no_sun.states[0].sun.reset();
  no_sky.states[0].sky.reset();
  const auto both = counted(full_scene()), sky_only = counted(no_sun), sun_only = counted(no_sky);
  CHECK(both.work.at("direct_fragments") > sky_only.work.at("direct_fragments"));
  CHECK(both.bytes.at("direct") > sky_only.bytes.at("direct"));
  CHECK(both.bytes.at("direct") > sun_only.bytes.at("direct"));
  // the sun's first reflection is kept per side
  CHECK(sky_only.bytes.at("links") < both.bytes.at("links"));
  CHECK(sky_only.work.at("links") == both.work.at("links"));
  CHECK(sky_only.planned_sun == 0);
  // the sky's light is found along the lines of scattering: it needs no projections of its own
  CHECK(sky_only.work.at("direct_fragments") == 0);
  CHECK(sun_only.work.at("direct_fragments") == both.work.at("direct_fragments"));
  CHECK(sun_only.work.at("fragments") == both.work.at("fragments"));
  for (const auto* run : {&both, &sky_only, &sun_only}) CHECK(run->planned_sky == 0);
  CHECK(sun_only.planned_bytes.at("direct") < both.planned_bytes.at("direct"));
}

TEST_CASE("absent: scattering", "[absent]") {
  auto black = full_scene();
  black.optics = {uniform_optics("leaf", {0, 0}, {0, 0})};
  black.ground->optics = uniform_optics("ground", {0, 0}, {0, 0});
  auto no_sky = full_scene();
  no_sky.states[0].sky.reset();
  const auto all = counted(full_scene()), direct = counted(full_scene(), RadiosityMethod::direct), dark = counted(black),
             sun_only = counted(no_sky, RadiosityMethod::direct);
  for (const auto* run : {&direct, &dark}) {
    CHECK(run->bytes.count("links") == 0);
    CHECK(run->bytes.count("fields") == 0);
    CHECK(run->work.count("links") == 0);
    CHECK(run->work.count("fragments") == 0);
    CHECK(run->seconds.count("lines") == 0);
    CHECK(run->planned_lines == 0);
    CHECK(run->planned_links == 0);
    // without lines of scattering the sky needs projections of its own; the sun's are the same
    CHECK(run->planned_sky > 0);
    CHECK(run->planned_sun == all.planned_sun);
    CHECK(run->work.at("direct_fragments") > all.work.at("direct_fragments"));
  }
  CHECK(dark.work.at("direct_fragments") == direct.work.at("direct_fragments"));
  CHECK(sun_only.work.at("direct_fragments") == all.work.at("direct_fragments"));
  CHECK(sun_only.planned_sky == 0);
  CHECK(direct.applications == 0);
  CHECK(dark.applications == 1);  // the statement that nothing is left to solve
}

TEST_CASE("absent: a second band, a second state", "[absent]") {
  auto one = full_scene(), two_states = full_scene();
  one.bands = {"PAR"};
  one.band_units = {"W m^-2"};
  one.optics = {{"leaf", {0.07f}, {0.12f}, {0.04f}}};
  one.ground->optics = uniform_optics("ground", {0.1}, {0});
  one.states[0].sun->irradiance = {400};
  one.states[0].sky->irradiance = {100};
  two_states.states.push_back(two_states.states[0]);
  const auto a = counted(one), b = counted(full_scene()), c = counted(two_states);
  // geometry is shared: elements, lines, links; direct light is kept per light source, not per band
  for (const char* what : {"elements", "cells", "fragments", "links", "direct_fragments"}) {
    CAPTURE(what);
    CHECK(a.work.at(what) == b.work.at(what));
    CHECK(c.work.at(what) == b.work.at(what));
  }
  CHECK(a.bytes.at("direct") == b.bytes.at("direct"));
  CHECK(a.bytes.at("links") < b.bytes.at("links"));  // the sun's first reflection
  CHECK(10 * a.planned_bytes.at("fields") < 6 * b.planned_bytes.at("fields"));
  CHECK(10 * c.planned_bytes.at("fields") > 17 * b.planned_bytes.at("fields"));
}

TEST_CASE("absent: ground and period", "[absent]") {
  auto bare = full_scene(), finite = full_scene();
  bare.ground.reset();
  finite.periodic.reset();
  const auto all = counted(full_scene()), no_ground = counted(bare), no_period = counted(finite);
  CHECK(no_ground.work.at("elements") == all.work.at("elements") - 72);  // 6 x 6 cells of two facets
  for (const char* what : {"elements", "direct", "links"}) {
    CAPTURE(what);
    CHECK(no_ground.bytes.at(what) < all.bytes.at(what));
  }
  CHECK(no_ground.work.at("fragments") < all.work.at("fragments"));
  // a period stores nothing: the same elements and cells; lines that leave at a side come in again and meet more
  CHECK(no_period.bytes.at("elements") == all.bytes.at("elements"));
  CHECK(no_period.bytes.at("direct") == all.bytes.at("direct"));
  CHECK(no_period.work.at("links") < all.work.at("links"));
}

TEST_CASE("absent: transmission", "[absent]") {
  auto opaque = full_scene();
  opaque.optics = {{"leaf", {0.07f, 0.42f}, {0.12f, 0.46f}, {0, 0}}};
  const auto reflection = [](const Scene& scene) { return Reflection(expand(scene), std::vector<std::uint32_t>(240, 0), 1); };
  const Reflection with = reflection(full_scene()), without = reflection(opaque);
  CHECK(with.transmits());
  CHECK_FALSE(without.transmits());
  // a table of two bands for leaf and ground, and a product on each side of each part in each application
  CHECK(with.bytes() - without.bytes() == 2 * 2 * sizeof(float));
  // what is seen, and thus traced, does not depend on optics
  const auto all = counted(full_scene()), no_light_through = counted(opaque);
  for (const char* what : {"elements", "cells", "fragments", "links", "direct_fragments"}) {
    CAPTURE(what);
    CHECK(no_light_through.work.at(what) == all.work.at(what));
  }
  CHECK(no_light_through.applications < all.applications);
}

TEST_CASE("absent: copies", "[absent]") {
  auto one = full_scene();
  one.periodic.reset();
  auto four = one;
  for (int i = 1; i < 4; ++i) four.plants[0].placements.push_back({Affine::translate({1.5 * i, 0, 0})});
  const auto instantiated = [](const Scene& scene) {
    FacetScene facets = expand(scene);
    Kept kept(1, facets.size(), 2);
    InstantiationSettings settings;
    settings.density = instantiation_density(Quality::draft);
    settings.threads = 1;  // how lines are shared out to threads leaves traces in what originals hold
    const auto report = solve_instantiation(scene, place(scene), settings, kept, silent());
    Counted out;
    out.work.insert(report.counts.begin(), report.counts.end());
    out.bytes.insert(report.memory.begin(), report.memory.end());
    return out;
  };
  // without copies there are no originals: the methods without them hold and count none, and are what is chosen
  const auto plain = counted(one, RadiosityMethod::clustering);
  CHECK(plain.work.count("originals") == 0);
  CHECK(plain.bytes.count("originals") == 0);
  CHECK(default_method(one, Quality::draft, silent()).method == "clustering");
  // with copies the originals are one and the same, what stands between copies grows with them
  const auto a = instantiated(one), b = instantiated(four);
  for (const auto& [name, n] : b.work) INFO(name << " " << a.work.at(name) << " " << n);
  CHECK(a.work.at("originals") == 1);
  CHECK(b.work.at("originals") == 1);
  CHECK(b.bytes.at("originals") == a.bytes.at("originals"));
  CHECK(b.bytes.at("fields") > a.bytes.at("fields"));
}
