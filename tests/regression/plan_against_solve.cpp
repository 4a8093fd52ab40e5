// What a plan predicts against what a solve by instantiation counts, part by part: memory and work within a quarter.
#include <catch2/catch.hpp>

#include <algorithm>

#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/policy/policy_toml.hpp>

#include "places.hpp"
#include "radiosity_runs.hpp"
#include "young_poplars.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

struct NoSink final : IrradianceSink {
  void rows(const IrradianceRows&) override {}
};

using Figures = std::vector<std::pair<std::string, std::uint64_t>>;

std::uint64_t figure(const Figures& figures, const std::string& name) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const auto& f) { return f.first == name; });
  INFO(name);
  REQUIRE(found != figures.end());
  return found->second;
}

/// Every figure of the solve but those in `unknown` is planned, and the other way round.
void check_figures(const Figures& planned, const Figures& seen, const std::string& unknown = "") {
  for (const auto& [name, amount] : planned) figure(seen, name);
  for (const auto& [name, amount] : seen) {
    if (name == unknown) continue;
    const auto expected = static_cast<double>(figure(planned, name)), there = static_cast<double>(amount);
    CAPTURE(name, expected, there);
    CHECK(expected >= 0.75 * there);
    CHECK(expected <= 1.25 * there);
  }
}

InstantiationPlan check_plan(const Scene& scene, InstantiationSettings settings = {}, const Depth& depth = {}) {
  settings.threads = 2;  // batches are worked on side by side
  const auto placed = place(scene, depth);
  const auto plan = plan_instantiation(scene, placed, settings, silent());
  NoSink sink;
  const auto report = solve_instantiation(scene, placed, settings, sink, silent());
  CHECK(plan.originals == figure(report.counts, "originals"));
  CHECK(plan.copies == figure(report.counts, "copies"));
  CHECK(plan.elements == figure(report.counts, "elements"));
  check_figures(plan.counts, report.counts, "sweeps");  // how often light goes to and fro inside copies, optics decide
  check_figures(plan.memory, report.memory);
  return plan;
}

Scene light_over(std::vector<Optics> optics) {
  auto scene = scene_with({"PAR", "NIR"}, std::move(optics));
  sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
  return scene;
}

/// Crowns of 1 m, n x n of them, so far apart from each other.
Scene grove(int n, double apart) {
  auto scene = light_over({uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({apart * n, apart * n}, {0.5 * apart * n, 0.5 * apart * n}, {8, 8}, {0.12, 0.2});
  add(scene, "crown", leaves(800, 0.05, {1, 1, 1}, 3), 0);
  scene.plants[0].placements.clear();
  for (int i = 0; i < n * n; ++i) scene.plants[0].placements.push_back(placed({{apart * (i % n), apart * (i / n), 0}}));
  return scene;
}

/// A crown, a larger one, the former stretched and the latter mirrored; rows of crowns in two blocks.
Scene nested() {
  auto scene = grove(1, 4);
  scene.ground = flat_ground({16, 16}, {8, 8}, {16, 16}, {0.12, 0.2});
  add(scene, "bush", leaves(500, 0.08, {1.5, 1.5, 1}, 5), 0);
  scene.plants[1].placements = {placed({{10, 1, 0}}), placed({{13, 1, 0}, 40, 0.8, 0, 0, true})};
  Placement stretched;
  stretched.map = Affine::translate({1, 12, 0});
  stretched.map.linear[0] *= 1.5;
  scene.plants[0].placements = {stretched};
  GroupEntry row, block;
  row.name = "row";
  for (int i = 0; i < 3; ++i) row.members.push_back({false, 0, placed({{1.7 * i, 0, 0}, 30.0 * i})});
  block.name = "block";
  for (int i = 0; i < 2; ++i) block.members.push_back({true, 0, placed({{0, 1.7 * i, 0}})});
  block.placements = {placed({{1, 1, 0}}), placed({{1, 6, 0}, 0, 1.2})};
  scene.groups = {row, block};
  return scene;
}

/// Poplars of three years, no two alike.
Scene poplars(std::uint32_t count, const std::string& policy) {
  auto scene = light_over({uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40}), uniform_optics("bark", {0.2, 0.4}, {0, 0})});
  scene.plants = young_poplars::entries(count, policy.empty() ? policy : SUNFLECK_SOURCE_DIR "/policies/" + policy);
  return scene;
}

}  // namespace

TEST_CASE("plan against solve: copies of one original, few and many", "[plan]") {
  check_plan(grove(1, 2));
  check_plan(grove(3, 1.6));
}

TEST_CASE("plan against solve: draft and fine", "[plan]") {
  InstantiationSettings settings;
  settings.density = instantiation_density(Quality::draft);
  check_plan(grove(2, 1.6), settings);
  settings.density = instantiation_density(Quality::fine);
  check_plan(grove(2, 1.6), settings);
}

TEST_CASE("plan against solve: a periodic cell", "[plan]") {
  auto scene = grove(2, 1.5);
  scene.periodic = PeriodicCell{0, 0, 3, 3};
  check_plan(scene);
}

TEST_CASE("plan against solve: copies that reach into each other", "[plan]") {
  const auto plan = check_plan(grove(2, 0.8));
  CHECK(plan.merged_copies == 4);
}

TEST_CASE("plan against solve: several originals, groups in groups, mirrored, scaled and stretched copies", "[plan]") {
  const auto plan = check_plan(nested());
  CHECK(plan.originals == 3);
  CHECK(plan.copies == 15);
}

TEST_CASE("plan against solve: three states, two suns", "[plan]") {
  auto scene = grove(2, 1.6);
  scene.states.push_back(scene.states[0]);
  scene.states.push_back(scene.states[0]);
  scene.states[1].sun->direction = glm::normalize(Vec3{-0.2, 0.6, 0.5});
  scene.states[2].sun.reset();
  check_plan(scene);
}

TEST_CASE("plan against solve: a sky alone", "[plan]") {
  auto scene = grove(2, 1.6);
  scene.states[0].sun.reset();
  check_plan(scene);
}

TEST_CASE("plan against solve: one crown opened, the others closed", "[plan]") {
  check_plan(grove(3, 1.6), {}, {{"crown 4"}, {}});
}

TEST_CASE("plan against solve: plants of which nothing is alike", "[plan]") {
  const auto plan = check_plan(poplars(3, ""));
  CHECK(plan.originals == 3);
  CHECK(plan.structures == 0);
  CHECK(plan.opened_alone == 0);
}

TEST_CASE("plan against solve: plants whose branches share originals until they are opened", "[plan]") {
  const auto scene = poplars(3, "poplar.toml");
  const auto classes = classes_of_policies(scene);
  REQUIRE(classes);
  InstantiationSettings settings;
  settings.classes = &*classes;
  const auto plan = check_plan(scene, settings);
  CHECK(plan.opened_alone == 3);
  CHECK(plan.structures > plan.pieces);
  CHECK(plan.copies_of_pieces == plan.copies);
  // what stands for plants until they are opened takes less than their own geometry would
  const auto exact = plan_instantiation(scene, place(scene), {}, silent());
  CHECK(figure(plan.memory, "originals") < figure(exact.memory, "originals") / 2);
  // but all lines of the last gather are followed
  CHECK(static_cast<double>(figure(plan.counts, "gather_fragments")) ==
        Approx(static_cast<double>(figure(exact.counts, "gather_fragments"))).epsilon(0.02));
}

TEST_CASE("a plan made of a part of the copies predicts what one of all of them does", "[plan]") {
  auto scene = grove(8, 2);
  scene.ground->cells = {2, 2};
  InstantiationSettings settings;
  settings.threads = 2;
  const auto part_placed = place(scene, {}, 16);
  REQUIRE(part_placed.share == 0.25);
  const auto all = plan_instantiation(scene, place(scene), settings, silent()),
             part = plan_instantiation(scene, part_placed, settings, silent());
  CHECK(part.copies == all.copies);
  CHECK(part.elements == all.elements);
  check_figures(part.counts, all.counts);
  check_figures(part.memory, all.memory, "lanes");  // of as many batches as threads: the same
  CHECK(figure(part.memory, "lanes") <= figure(all.memory, "lanes"));
}
