// Memory and work of the instantiation, counted by the program, as copies are added (against its plan: plan_against_solve.cpp).
#include <catch2/catch.hpp>

#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "radiosity_runs.hpp"
#include "run_program.hpp"
#include "sanitized.hpp"
#include "young_poplars.hpp"

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

TEST_CASE("instantiation: less is held at one time than all parts together") {
  const auto scene = grove(3);
  REQUIRE(repeats(scene));
  Counted sink;
  const auto report = solve_instantiation(scene, place(scene), {}, sink, silent());
  CHECK(sink.facets == 9 * 3000 + 128);
  std::uint64_t held = 0;
  for (const auto& [name, bytes] : report.memory)
    if (name != "at_once") held += bytes;
  CHECK(value(report.memory, "at_once") < held);
  CHECK(value(report.memory, "at_once") > held / 2);
}

TEST_CASE("instantiation: originals take what is unique, whatever the number of copies") {
  Counted few_rows, many_rows;
  InstantiationSettings settings;
  settings.threads = 1;  // how lines are shared out to threads leaves traces in what these hold
  const auto few = solve_instantiation(grove(3), place(grove(3)), settings, few_rows, silent());  // eight and more have finer operators
  const auto many = solve_instantiation(grove(6), place(grove(6)), settings, many_rows, silent());
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

TEST_CASE("instantiation: what each part holds, to 5 %") {
  InstantiationSettings settings;
  settings.threads = 1;  // how lines are shared out to threads leaves traces in what these hold
  Counted sink;
  const auto report = solve_instantiation(grove(3), place(grove(3)), settings, sink, silent());
  const std::vector<std::pair<std::string, double>> expected{{"originals", 3498191.0}, {"sun", 135000.0},      {"rays", 1048008.0},
                                                             {"lanes", 11876736.0},    {"fields", 3112960.0},  {"rows", 648000.0},
                                                             {"fine", 24476576.0},     {"at_once", 29351079.0}};
  for (const auto& [name, bytes] : expected) {
    INFO(name << " " << value(report.memory, name));
    CHECK(static_cast<double>(value(report.memory, name)) == Approx(bytes).epsilon(0.05));
  }
}

TEST_CASE("instantiation: the process's own peak is within 1.3 of what is counted") {
  if (sanitized) {
    WARN("skipped: a sanitizer's shadow memory and kept-back blocks are part of the process's peak");
    return;
  }
  const TemporaryFolder folder;
  folder.file("three.toml", young_poplars::scene_text(6, 4));
  const auto run = run_sunfleck({"solve", folder.path("three.toml"), "-o", folder.path("r.h5"), "--method", "instantiation", "--quality",
                                 "draft", "--no-certificate", "--threads", "2"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const auto memory = Result(folder.path("r.h5")).memory();
  const auto counted = static_cast<double>(value(memory, "at_once")), held = static_cast<double>(value(memory, "peak_resident"));
  CHECK(value(memory, "program") > 0);
  CHECK(counted < 1.1 * held);  // nor is more counted than is there
  CHECK(held < 1.3 * counted);
}
