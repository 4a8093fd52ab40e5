// Memory and work of the instantiation, counted by the program: against its own plan, and as copies are added.
#include <catch2/catch.hpp>

#include <sunfleck/instantiation/plan.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Scene grove(int n) {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({1.6 * n, 1.6 * n}, {0.8 * n, 0.8 * n}, {8, 8}, {0.12, 0.2});
  add(scene, "crown", leaves(1500, 0.04, {1, 1, 1}, 3), 0);
  scene.plants[0].placements.clear();
  for (int i = 0; i < n * n; ++i) {
    Stance s;
    s.position = {1.6 * (i % n), 1.6 * (i / n), 0};
    scene.plants[0].placements.push_back(placed(s));
  }
  sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
  return scene;
}

struct Counted final : IrradianceSink {
  void rows(const IrradianceRows& r) override { facets += r.count; }
  std::size_t facets = 0;
};

std::uint64_t value(const std::vector<std::pair<std::string, std::uint64_t>>& list, const std::string& name) {
  for (const auto& [key, v] : list)
    if (key == name) return v;
  FAIL("no " << name);
  return 0;
}

}  // namespace

TEST_CASE("instantiation: what the plan predicts is held, within a quarter") {
  const auto scene = grove(3);
  REQUIRE(repeats(scene));
  Counted sink;
  const auto report = solve_instantiation(scene, place(scene), {}, sink, silent());
  const auto plan = plan_instantiation(scene, place(scene), {}, silent());
  CHECK(sink.facets == 9 * 3000 + 128);
  CHECK(plan.originals == value(report.counts, "originals"));
  CHECK(plan.copies == value(report.counts, "copies"));
  CHECK(plan.elements == value(report.counts, "elements"));
  CHECK(static_cast<double>(plan.links) == Approx(static_cast<double>(value(report.counts, "links"))).epsilon(0.25));
  std::uint64_t held = 0;
  for (const auto& [name, bytes] : report.memory) held += bytes;
  CHECK(static_cast<double>(plan.memory_total()) == Approx(static_cast<double>(held)).epsilon(0.25));
}

TEST_CASE("instantiation: originals take what is unique, whatever the number of copies") {
  Counted few_rows, many_rows;
  const auto few = solve_instantiation(grove(2), place(grove(2)), {}, few_rows, silent());
  const auto many = solve_instantiation(grove(4), place(grove(4)), {}, many_rows, silent());
  for (const char* name : {"originals", "fine"}) CHECK(value(few.memory, name) == value(many.memory, name));
  CHECK(value(few.counts, "links") == value(many.counts, "links"));
  CHECK(value(many.memory, "sun") == Approx(4.0 * static_cast<double>(value(few.memory, "sun"))).epsilon(0.01));
}

TEST_CASE("instantiation: without sun, no cell is projected; black leaves need one pass") {
  auto scene = grove(2);
  scene.states[0].sun.reset();
  scene.optics = {uniform_optics("leaf", {0, 0}, {0, 0})};
  scene.ground->optics = uniform_optics("soil", {0, 0}, {0, 0});
  Counted sink;
  const auto report = solve_instantiation(scene, place(scene), {}, sink, silent());
  CHECK(value(report.counts, "sun_fragments") == 0);
  for (const auto& [name, bytes] : report.memory) CHECK(name != "sun");
  CHECK(report.convergence.size() <= 2);
}
