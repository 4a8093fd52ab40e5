// `sunfleck plan` as its user meets it: what it predicts stands beside what a solve counts, and bad policies are refused as by a solve.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <sunfleck/result/result_reader.hpp>

#include "run_program.hpp"
#include "young_poplars.hpp"

namespace {

using sunfleck::Result;

/// Three young poplars, no two alike, with a policy of their own.
struct Poplars {
  explicit Poplars(const std::string& policy) {
    path = folder.file("three.toml", young_poplars::scene_text(3, 2, "policy = \"p.toml\"\n"));
    folder.file("p.toml", policy);
  }
  ProgramRun plan(const std::string& method = "instantiation") const {
    return run_sunfleck({"plan", path, "--json", "--method", method, "--quality", "draft", "--threads", "2"});
  }
  ProgramRun solve(const std::string& method = "instantiation") const {
    return run_sunfleck(
        {"solve", path, "-o", folder.path("r.h5"), "--method", method, "--quality", "draft", "--threads", "2", "--no-certificate"});
  }
  TemporaryFolder folder;
  std::string path;
};

const std::string branches = "[type.branch]\nparameters = { leaf_count = [1, 4, 16, 64], order = \"each\" }\nleast_members = 2\n";

}  // namespace

TEST_CASE("plan knows the policies of a scene, and names its figures as the result does", "[cli][plan]") {
  const Poplars scene(branches);
  const auto run = scene.plan();
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const auto plan = nlohmann::json::parse(run.out);
  CHECK(plan["done"]["policies"].get<std::string>().find("of 3 plants, which are opened one by one") != std::string::npos);
  const auto solved = scene.solve();
  INFO(solved.err);
  REQUIRE(solved.exit_code == 0);
  const Result result(scene.folder.path("r.h5"));
  for (const auto& [name, bytes] : result.memory()) {
    if (name == "peak_resident") continue;
    CAPTURE(name, bytes);
    REQUIRE(plan["memory_bytes"].contains(name));
    CHECK(plan["memory_bytes"][name].get<double>() == Approx(static_cast<double>(bytes)).epsilon(0.25));
  }
  for (const auto& [name, amount] : result.counts()) {
    if (name == "sweeps") continue;
    CAPTURE(name, amount);
    REQUIRE(plan["work"].contains(name));
    CHECK(plan["work"][name].get<double>() == Approx(static_cast<double>(amount)).epsilon(0.25));
  }
  CHECK(nlohmann::json::parse(scene.plan("flat").out)["left_out"]["policies"] ==
        "method 'flat' takes every plant as it is, 'instantiation' follows them");
}

TEST_CASE("plan refuses, as solve does, to leave parts closed with a method that cannot", "[cli][plan]") {
  const Poplars scene(branches);
  const std::string path = scene.folder.file("depth.toml", text_of(scene.path) + "[solve]\nstop_at = \"plant\"\n");
  const auto plan = run_sunfleck({"plan", path, "--method", "clustering"});
  CHECK(plan.exit_code == 2);
  CHECK(plan.err == "sunfleck: " + path + ": solve.stop_at: found it with method clustering; expected method instantiation\n");
}

TEST_CASE("plan refuses policies as solve does", "[cli][plan]") {
  const std::vector<std::pair<std::string, std::string>> broken{
      {"[type.branch\n", "p.toml"},
      {"[type.branch]\nparameters = { leaf_count = [4, 1] }\n", "p.toml:2"},
      {"[type.branch]\nparameters = { vigour = [1, 4] }\n", "p.toml:2"},
      {"[type.brunch]\nparameters = { leaf_count = [1, 4] }\n", "brunch"},
  };
  for (const auto& [policy, where] : broken) {
    const Poplars scene(policy);
    const auto plan = scene.plan(), solve = scene.solve();
    CAPTURE(policy, plan.err, solve.err);
    CHECK(plan.exit_code == 2);
    CHECK(solve.exit_code == 2);
    CHECK(plan.out.empty());
    CHECK(plan.err.find(where) != std::string::npos);
    // a solve says first what it has read
    const auto at = solve.err.find("sunfleck: ");
    REQUIRE(at != std::string::npos);
    CHECK(plan.err == solve.err.substr(at));
  }
}
