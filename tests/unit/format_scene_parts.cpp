// Parts of scenes in memory, in the words of scene files.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/format/scene_parts.hpp>
#include <sunfleck/plant/build.hpp>

using namespace sunfleck;
using Catch::Matchers::StartsWith;

namespace {

Scene two_bands() {
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units.assign(2, "W m^-2");
  return scene;
}

const Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};

}  // namespace

TEST_CASE("scene parts: light takes the place of the light before, or changes nothing", "[format][scene_parts]") {
  Scene scene = two_bands();
  CHECK(replace_light(scene, "sun = { direction = [0, 0, 2], irradiance = { PAR = 1, NIR = 2 } }").empty());
  REQUIRE(scene.states.size() == 1);
  CHECK(scene.states[0].sun->direction == Vec3(0, 0, 1));
  CHECK_THROWS_WITH(replace_light(scene, "sky = { model = \"uniform\", irradiance = { PAR = 1 } }"),
                    "scene in memory: sky.irradiance.NIR: found nothing; expected a number: every band needs one");
  CHECK_THROWS_WITH(replace_light(scene, "sky = { modell = \"uniform\" }"),
                    StartsWith("scene in memory: sky.modell: unknown key; did you mean \"model\"?"));
  CHECK(scene.states[0].sun.has_value());
  const auto notes =
      replace_light(scene,
                    "state = [ { sun = { elevation = -3, azimuth = 0, irradiance = { PAR = 1, NIR = 2 } } }, { sky = { model = "
                    "\"uniform\", irradiance = { PAR = 1, NIR = 1 } } } ]");
  CHECK(scene.states.size() == 2);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], StartsWith("scene in memory: state[0].sun: the sun is 3.00 degrees below the horizon"));
  CHECK(scene.notes.empty());
}

TEST_CASE("scene parts: optics once under a name, unless they are to be replaced", "[format][scene_parts]") {
  Scene scene = two_bands();
  add_optics(scene, "optics = { leaf = { reflectance = { PAR = 0.1, NIR = 0.5 } } }");
  CHECK_THROWS_WITH(add_optics(scene, "optics = { leaf = { reflectance = { PAR = 0.2, NIR = 0.5 } } }"),
                    StartsWith("scene in memory: optics.name: found \"leaf\" twice"));
  CHECK(scene.optics[0].reflectance_front[0] == 0.1f);
  add_optics(scene, "optics = { leaf = { reflectance = { PAR = 0.2, NIR = 0.5 } } }", true);
  REQUIRE(scene.optics.size() == 1);
  CHECK(scene.optics[0].reflectance_front[0] == 0.2f);
}

TEST_CASE("scene parts: meshes in memory take the place of files", "[format][scene_parts]") {
  Scene scene = two_bands();
  replace_ground(scene, "ground = { reflectance = { PAR = 0.1, NIR = 0.2 } }", &triangle);
  CHECK(scene.ground->mesh->triangles.size() == 1);
  CHECK_THROWS_WITH(replace_ground(scene, "ground = { size = [1, 1], reflectance = { PAR = 0.1, NIR = 0.2 } }", &triangle),
                    StartsWith("scene in memory: ground.size: found `size` beside `mesh`"));
  add_lamp(scene, "lamp = [ { name = \"a\", power = { PAR = 1, NIR = 0 } } ]", &triangle);
  CHECK(scene.lamps[0].mesh.vertices.size() == 3);
  CHECK_THROWS_WITH(add_lamp(scene, "lamp = [ { name = \"b\", power = { PAR = 1, NIR = 0 } } ]"),
                    "scene in memory: lamp[0]: found neither `mesh` nor `ies`; expected one of them");
  CHECK_THROWS_WITH(add_lamp(scene, "lamp = [ { name = \"a\", power = { PAR = 1, NIR = 0 } } ]", &triangle),
                    StartsWith("scene in memory: lamp.name: found \"a\" twice"));
  add_sensor(scene, "sensor = [ { name = \"s\" } ]", &triangle);
  CHECK(std::get<Mesh>(scene.sensors[0].shape).triangles.size() == 1);
  CHECK_THROWS_WITH(add_sensor(scene, "sensor = [ { name = \"t\", grid = { z = 1, cells = [1, 1] } } ]", &triangle),
                    StartsWith("scene in memory: sensor[0]: found several shapes"));
  CHECK(scene.sensors.size() == 1);
}

TEST_CASE("scene parts: places are those of scene files", "[format][scene_parts]") {
  const Scene scene = two_bands();
  const auto places = read_places(scene, "place = [ { position = [1, 2, 3] }, { grid = { step = [1, 1], count = [2, 3] } } ]");
  REQUIRE(places.size() == 7);
  CHECK(places[0].map.translation == Vec3(1, 2, 3));
  CHECK_THROWS_WITH(read_places(scene, "place = [ { turn = 3 } ]"), StartsWith("scene in memory: place[0].position: found nothing"));
}
