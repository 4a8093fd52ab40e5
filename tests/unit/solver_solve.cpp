// The solver's one call: what it prepares, keeps and refuses.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/solver/result_file.hpp>
#include <sunfleck/sunfleck.hpp>

#include "radiosity_runs.hpp"
#include "scratch_folder.hpp"

using namespace sunfleck;
using radiosity_runs::leaves;

namespace {

/// Two crowns, ground, sun and overcast sky.
Scene crowns() {
  auto scene = reference_runs::scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({3, 3}, {1, 0.5}, {3, 3}, {0.12, 0.2});
  reference_runs::sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
  reference_runs::add(scene, "crown", leaves(60, 0.12, {1, 1, 1}, 3), 0);
  scene.plants[0].placements.push_back({Affine::translate({1.2, 0, 0})});
  return scene;
}

RunSettings quick() {
  RunSettings run;
  run.quality = Quality::draft;
  run.certificate_rays = 50'000;
  return run;
}

/// Cancels at the n-th question.
class Impatient final : public Progress {
 public:
  explicit Impatient(int questions) : left_(questions) {}
  bool cancelled() const override { return --left_ < 0; }

 private:
  mutable std::atomic<int> left_;
};

}  // namespace

TEST_CASE("solve: light of facets and organs in memory, whose sums are each other's and the balance's", "[solver]") {
  const Scene scene = crowns();
  const Solution s = solve(scene, quick());
  REQUIRE(s.organs.count == 2 * 60 + 9);
  REQUIRE(s.facets.count == 2 * 120 + 18);
  CHECK(s.organs.name(0) == "crown_1");
  CHECK(s.organs.placement(60) == "crown[1]");
  CHECK(s.organs.type(120) == "ground");
  CHECK(s.organs.plant[120] == of_ground);
  REQUIRE(s.certificate);
  CHECK(s.verdict.empty());
  for (std::size_t b = 0; b < 2; ++b) {
    std::vector<double> sum(s.organs.count, 0.0), front(s.organs.count, 0.0);
    double leaves_absorb = 0;
    for (std::size_t f = 0; f < s.facets.count; ++f) {
      sum[s.facets.organ[f]] += s.facets.area[f] * s.facets.absorbed[f * 2 + b];
      front[s.facets.organ[f]] += s.facets.area[f] * s.facets.irradiance[f * 4 + b];
    }
    for (std::size_t o = 0; o < s.organs.count; ++o) {
      CHECK(s.organs.absorbed_in(o, b) == Approx(sum[o]).epsilon(1e-6));
      CHECK(s.organs.irradiance_on(o, 0, b) * s.organs.area[o] == Approx(front[o]).epsilon(1e-6));
      if (o < 120) leaves_absorb += s.organs.absorbed_in(o, b);
    }
    CHECK(leaves_absorb == Approx(s.report.balance[0][b].leaves).epsilon(1e-5));
  }
  const Solution organs_only = solve(scene, quick(), silent(), false);
  CHECK(organs_only.facets.count == 0);
  CHECK(organs_only.organs.absorbed == s.organs.absorbed);
}

TEST_CASE("solve: memory and file hold the same, for any number of threads", "[solver]") {
  const ScratchFolder folder;
  const Scene scene = crowns();
  RunSettings run = quick();
  const Solution s = solve(scene, run);
  ResultFile file(folder.path + "/a.h5");
  run.threads = 1;
  const SolveResult of_file = solve(scene, run, file);
  CHECK(of_file.certificate->rmse == s.certificate->rmse);
  const Result result(folder.path + "/a.h5");
  CHECK(result.state_rows<float>("facets/irradiance", 0, 0, result.facet_count()) == s.facets.irradiance);
  CHECK(result.state_rows<float>("facets/sunlit", 0, 0, result.facet_count()) == s.facets.sunlit);
  const auto absorbed = result.state_rows<float>("organs/absorbed", 0, 0, result.organ_count());
  for (std::size_t i = 0; i < absorbed.size(); ++i) REQUIRE(absorbed[i] == static_cast<float>(s.organs.absorbed[i]));
  write_result(scene, s, folder.path + "/b.h5");
  const Result again(folder.path + "/b.h5");
  CHECK(again.state_rows<float>("facets/irradiance", 0, 0, again.facet_count()) == s.facets.irradiance);
  CHECK(again.certificate()->rmse.size() == 2);
  CHECK_THROWS_AS(write_result(scene, solve(scene, quick(), silent(), false), folder.path + "/c.h5"), UsageError);
}

TEST_CASE("solve: a clear sky need not be prepared, and gives what it says on open ground", "[solver]") {
  Scene scene = reference_runs::scene_with({"PAR"}, {uniform_optics("black", {0}, {0})});
  scene.ground = flat_ground({1, 1}, {0, 0}, {1, 1}, {0});
  reference_runs::sky(scene, SkyModel::clear, 100);
  scene.states[0].sky->sun = glm::normalize(Vec3{0.3, 0.2, 0.7});
  CHECK_THROWS_WITH(check_scene(scene), Catch::Contains("found a clear sky that is not prepared"));
  const Solution s = solve(scene);
  CHECK(s.organs.irradiance_on(0, 0) == Approx(100).epsilon(0.002));
  scene.states[0].sky->sun = Vec3{0, 0, -1};
  CHECK_THROWS_WITH(solve(scene), Catch::Contains("sun below the horizon"));
}

TEST_CASE("solve: a scene that cannot be is refused before anything is done", "[solver]") {
  Scene scene = crowns();
  scene.optics[0].transmittance[1] = 0.6f;
  CHECK_THROWS_AS(solve(scene, quick()), InputError);
  scene = crowns();
  scene.plants.clear(), scene.ground.reset();
  CHECK_THROWS_AS(solve(scene, quick()), InputError);
  RunSettings run = quick();
  run.method = "radiance";
  CHECK_THROWS_AS(solve(crowns(), run), UsageError);
  run = quick();
  run.error = {{"PAR", 0.01}};
  CHECK_THROWS_WITH(solve(crowns(), run), Catch::StartsWith("error: found with a quality"));
  run.quality.reset();
  run.error = {{"PRA", 0.01}};
  CHECK_THROWS_WITH(solve(crowns(), run), "error: found band 'PRA'; expected one of PAR, NIR (did you mean 'PAR'?)");
  run.error = {{"", 0.9}};
  CHECK_THROWS_WITH(solve(crowns(), run), Catch::StartsWith("error: found 0.9"));
}

TEST_CASE("solve: a stop ends it wherever it comes, and the next solve works", "[solver]") {
  const Scene scene = crowns();
  for (int questions : {0, 3, 20}) {
    Impatient progress(questions);
    CHECK_THROWS_AS(solve(scene, quick(), progress), Stopped);
  }
  CHECK(solve(scene, quick()).report.status == SolveStatus::converged);
}

TEST_CASE("solve: an error that is wanted and not reached is said", "[solver]") {
  RunSettings run;
  run.method = "instantiation";
  run.error = {{"", 1e-4}};
  run.certificate_rays = 20'000;
  const Solution s = solve(crowns(), run);
  CHECK(s.report.status == SolveStatus::not_converged);
  CHECK(s.verdict.find("was not reached") != std::string::npos);
}
