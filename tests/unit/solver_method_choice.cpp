#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>

#include <sunfleck/solver/method_choice.hpp>
#include "reference_runs.hpp"

using namespace sunfleck;

TEST_CASE("the command line comes before the scene, the scene before the defaults", "[cli]") {
  SolveChoice scene;
  CHECK(choose_method({}, {}, scene).method == "clustering");
  CHECK(choose_method({}, {}, scene).quality == Quality::standard);
  scene.method = "flat";
  scene.quality = Quality::fine;
  CHECK(choose_method({}, {}, scene).method == "flat");
  CHECK(choose_method({}, {}, scene).quality == Quality::fine);
  CHECK(choose_method("direct", "draft", scene).method == "direct");
  CHECK(choose_method("direct", "draft", scene).quality == Quality::draft);
}

TEST_CASE("an unknown method names those there are", "[cli]") {
  CHECK_THROWS_WITH(choose_method("radiance", {}, SolveChoice{}),
                    "method: found 'radiance'; expected one of instantiation, clustering, flat, direct, reference");
  CHECK_THROWS_WITH(
      choose_method("clusterng", {}, SolveChoice{}),
      "method: found 'clusterng'; expected one of instantiation, clustering, flat, direct, reference (did you mean 'clustering'?)");
  CHECK_THROWS_AS(choose_method("clusterng", {}, SolveChoice{}), UsageError);
}

TEST_CASE("one house over many plants decides the default, however many they are", "[cli]") {
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
