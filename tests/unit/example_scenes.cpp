// Scenes of plants/ that the documentation shows.
#include <catch2/catch.hpp>

#include <sunfleck/format/scene_toml.hpp>

#include "places.hpp"

using namespace sunfleck;

TEST_CASE("The growth chamber of the how-to is read whole: lamps, walls, sensors", "[format][lamps][sensors]") {
  const Scene scene = read_scene(SUNFLECK_SOURCE_DIR "/plants/chamber.toml");
  REQUIRE(scene.lamps.size() == 3);
  CHECK(scene.lamps[0].placements.size() == 4);
  CHECK(scene.lamps[0].states == std::vector<std::uint32_t>{0});
  REQUIRE(scene.lamps[1].photometry);
  CHECK(scene.lamps[1].photometry->vertical_deg.size() == 13);
  CHECK(scene.lamps[1].states.empty());
  REQUIRE(scene.sensors.size() == 3);
  CHECK(scene.states.size() == 2);
  CHECK_FALSE(scene.states[0].sun);
  CHECK_FALSE(scene.states[0].sky);
}
