#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>

#include "cli/method_choice.hpp"

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
