#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>

#include <sunfleck/solver/method_choice.hpp>
#include "reference_runs.hpp"

using namespace sunfleck;

namespace {

Scene leaf() {
  auto scene = reference_runs::scene_with({"PAR"}, {uniform_optics("leaf", {0.1}, {0.05})});
  reference_runs::sky(scene, SkyModel::standard_overcast, 100);
  reference_runs::add(scene, "leaf", {Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}}, 0);
  return scene;
}

MethodChoice chosen(const RunSettings& run) {
  return choose_method(run, leaf(), silent());
}

RunSettings with_method(const std::string& name) {
  RunSettings run;
  run.method = name;
  return run;
}

}  // namespace

TEST_CASE("what a run says comes before the scene file's own run, that before the defaults", "[solver]") {
  CHECK(chosen({}).method == "clustering");
  CHECK(chosen({}).quality == Quality::standard);
  RunSettings of_scene = with_method("flat");
  of_scene.quality = Quality::fine;
  of_scene.seed = 7;
  of_scene.depth.only = {"a"};
  CHECK(chosen(filled_up({}, of_scene)).method == "flat");
  CHECK(chosen(filled_up({}, of_scene)).quality == Quality::fine);
  CHECK(filled_up({}, of_scene).depth.only == std::vector<std::string>{"a"});
  RunSettings run = with_method("direct");
  run.quality = Quality::draft;
  run.depth.only = {"b"};
  run = filled_up(run, of_scene);
  CHECK(chosen(run).method == "direct");
  CHECK(chosen(run).quality == Quality::draft);
  CHECK(run.seed == 7u);
  CHECK(run.depth.only == std::vector<std::string>{"b"});
}

TEST_CASE("a wanted error takes the place of the scene file's quality, and has a certificate", "[solver]") {
  RunSettings of_scene;
  of_scene.quality = Quality::fine;
  of_scene.certificate = false;
  RunSettings run;
  run.error = {{"", 0.02}};
  run = filled_up(run, of_scene);
  CHECK_FALSE(run.quality);
  CHECK(run.certificate.value_or(true));
  CHECK(chosen(run).quality == Quality::draft);
}

TEST_CASE("an unknown method names those there are", "[solver]") {
  CHECK_THROWS_WITH(chosen(with_method("radiance")),
                    "method: found 'radiance'; expected one of instantiation, clustering, flat, direct, lattice, occlusion, reference");
  CHECK_THROWS_WITH(
      chosen(with_method("clusterng")),
      "method: found 'clusterng'; expected one of instantiation, clustering, flat, direct, lattice, occlusion, reference (did you mean 'clustering'?)");
  CHECK_THROWS_AS(chosen(with_method("clusterng")), UsageError);
}

TEST_CASE("one house over many plants decides the default, however many they are", "[solver]") {
  auto scene = reference_runs::scene_with({"PAR"}, {uniform_optics("leaf", {0.1}, {0.05})});
  reference_runs::sky(scene, SkyModel::standard_overcast, 100);
  reference_runs::add(scene, "crown", reference_runs::leaves(280, 0.05, {0.7, 0.7, 0.9}, 3), 0);
  scene.plants[0].placements.clear();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) scene.plants[0].placements.push_back({Affine::translate({1.2 * i, 1.2 * j, 0})});
  CHECK(default_method(scene, Quality::draft, silent()).method == "instantiation");
  const auto sheet = [](const Vec3& corner, const Vec3& u, const Vec3& v) {
    return Mesh{{corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}}};
  };
  reference_runs::add(scene, "house",
                      {sheet({-0.3, -0.3, 1.5}, {7.3, 0, 0}, {0, 7.3, 0}), sheet({-0.3, -0.3, 0}, {7.3, 0, 0}, {0, 0, 1.5}),
                       sheet({-0.3, 7, 0}, {7.3, 0, 0}, {0, 0, 1.5})},
                      0);
  CHECK(default_method(scene, Quality::draft, silent()).method == "clustering");
}
