// Lamps and sensors that cannot be.
#include <catch2/catch.hpp>

#include <scene_files.hpp>

using namespace sunfleck;

namespace {

const std::string sky = "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1 }\n";  // four lines
const std::map<std::string, std::string> files{{"down.obj", "v 0 0 2\nv 0 1 2\nv 1 1 2\nf 1 2 3\n"},
                                               {"up.obj", "v 0 0 2\nv 0 1 2\nv 1 1 2\nf 1 3 2\n"},
                                               {"flat.obj", "v 0 0 2\nv 0 1 2\nv 0 2 2\nf 1 2 3\n"},
                                               {"lamp.ies", "TILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n1 0\n"}};

std::string lamp(const std::string& keys) {
  return SceneFiles(sky + "[[lamp]]\n" + keys, files).message();
}
std::string sensor(const std::string& keys) {
  return SceneFiles(sky + "[[sensor]]\n" + keys, files).message();
}

}  // namespace

TEST_CASE("A lamp has one shape and one strength", "[hostile][scene]") {
  const std::string mesh = "mesh = \"down.obj\"\n", ies = "ies = \"lamp.ies\"\n", exitance = "exitance = { PAR = 1 }\n",
                    power = "power = { PAR = 1 }\n";
  CHECK(lamp(exitance) == "scene.toml:5: lamp[0]: found neither `mesh` nor `ies`; expected one of them");
  CHECK(lamp(mesh + ies + power) == "scene.toml:5: lamp[0]: found both `mesh` and `ies`; expected one of them");
  CHECK(lamp(mesh) == "scene.toml:5: lamp[0]: found neither `exitance` nor `power`; expected one of them per band");
  CHECK(lamp(mesh + exitance + power) == "scene.toml:5: lamp[0]: found both `exitance` and `power`; expected one of them per band");
  CHECK(lamp(ies + exitance) ==
        "scene.toml:7: lamp[0].exitance: found `exitance` beside `ies`; expected `power` per band: a photometric file says where light "
        "goes, not how much");
  CHECK(lamp(ies) == "scene.toml:5: lamp[0]: found no `power`; expected the power that the lamp gives off per band");
  CHECK(lamp(mesh + "exitance = { PAR = -1 }\n") == "scene.toml:7: lamp[0].exitance.PAR: found -1; expected a number of zero or more");
  CHECK(lamp(mesh + "exitance = { }\n") == "scene.toml:7: lamp[0].exitance.PAR: found nothing; expected a number: every band needs one");
  CHECK(lamp("mesh = \"flat.obj\"\n" + exitance) == "scene.toml: lamp[0].mesh: found faces of 0 m2 in all; expected an area above zero");
  CHECK(lamp("mesh = \"none.obj\"\n" + exitance) ==
        "scene.toml:6: lamp[0].mesh: found no file \"none.obj\"; expected a mesh file (its path is relative to the scene file)");
  CHECK(lamp(ies + power) == "scene.toml:5: lamp[0].position: found nothing; expected [x, y, z] [m], or `place`, or `grid`");
  CHECK(lamp(ies + power + "position = [0, 0, 2]\naim = [0, 0, 0]\n") ==
        "scene.toml:9: lamp[0].aim: found [0, 0, 0]; expected a vector that is not zero");
  CHECK(lamp(mesh + exitance + "position = [0, 0, 2]\n") ==
        "scene.toml:8: lamp[0].position: found `position`, `aim` or `turn` beside `mesh`; expected `place` or `grid`: a mesh stands as its "
        "file says, or there");
  CHECK(lamp(mesh + exitance + "states = [\"night\"]\n") ==
        "scene.toml:8: lamp[0].states[0]: found \"night\"; expected no `states`: the scene lists no [[state]]");
  CHECK(lamp(mesh + "exitence = { PAR = 1 }\n") == "scene.toml:7: lamp[0].exitence: unknown key; did you mean \"exitance\"?");
  CHECK(lamp(mesh + exitance) == "");
  CHECK(lamp(ies + power + "position = [0, 0, 2]\naim = [1, 0, -1]\nturn = 90\n") == "");
}

TEST_CASE("A lamp that looks up is worth a note, and lamps are light enough", "[hostile][scene]") {
  const std::string bands = "bands = [\"PAR\"]\n";
  const SceneFiles up(bands + "[[lamp]]\nmesh = \"up.obj\"\nexitance = { PAR = 1 }\n", files);
  REQUIRE(up.read().notes.size() == 1);
  CHECK(up.read().notes[0].find("no face of this lamp looks down") != std::string::npos);
  CHECK(SceneFiles(bands + "[[lamp]]\nmesh = \"down.obj\"\nexitance = { PAR = 1 }\n", files).read().notes.empty());
  const SceneFiles day(
      bands +
          "[[state]]\nname = \"day\"\nsky = { model = \"uniform\", irradiance = { PAR = 1 } }\n[[state]]\nname = \"night\"\n"
          "[[lamp]]\nmesh = \"down.obj\"\nexitance = { PAR = 1 }\nstates = [\"night\"]\n",
      files);
  CHECK(day.read().lamps[0].states == std::vector<std::uint32_t>{1});
}

TEST_CASE("A sensor has one shape and a name of its own", "[hostile][scene]") {
  CHECK(sensor("name = \"a\"\n") == "scene.toml:5: sensor[0]: found no shape; expected one of `grid`, `mesh` and `profile`");
  CHECK(sensor("grid = { z = 0, cells = [1, 1] }\n") ==
        "scene.toml:5: sensor[0].name: found nothing; expected a name, under which the result keeps it");
  CHECK(sensor("name = \"a\"\nmesh = \"up.obj\"\nprofile = { step = 1 }\n") ==
        "scene.toml:5: sensor[0]: found several shapes; expected one of `grid`, `mesh` and `profile`");
  CHECK(sensor("name = \"a/b\"\ngrid = { z = 0, cells = [1, 1] }\n") ==
        "scene.toml: sensor[0].name: found \"a/b\"; expected a name without \"/\", under which the result can keep it");
  CHECK(sensor("name = \"a\"\ngrid = { z = 0, cells = [1, 1] }\n[[sensor]]\nname = \"a\"\ngrid = { z = 1, cells = [1, 1] }\n") ==
        "scene.toml:9: sensor[1].name: found \"a\" twice; expected a name of its own for every sensor");
  CHECK(sensor("name = \"a\"\ngrid = { cells = [1, 1] }\n") ==
        "scene.toml:7: sensor[0].grid.z: found nothing; expected the height of the sensors [m]");
  CHECK(sensor("name = \"a\"\ngrid = { z = 0, cells = [0, 1] }\n") ==
        "scene.toml:7: sensor[0].grid.cells[0]: found 0; expected a whole number from 1 to 30000");
  CHECK(sensor("name = \"a\"\ngrid = { z = 0, cells = [30000, 30000] }\n") ==
        "scene.toml: sensor[0].grid.cells: found 900000000 cells; expected at most 10000000");
  CHECK(sensor("name = \"a\"\nprofile = { step = 0 }\n") ==
        "scene.toml:7: sensor[0].profile.step: found 0; expected a number above zero metres");
  CHECK(sensor("name = \"a\"\nprofile = { step = 1, low = 2, high = 1 }\n") ==
        "scene.toml:7: sensor[0].profile.high: found 1, below `low`; expected a height not below `low` [m]");
  CHECK(sensor("name = \"a\"\nsides = \"both\"\nprofile = { step = 1 }\n") ==
        "scene.toml:7: sensor[0].sides: found `sides` of a profile; expected no `sides`: it has both");
  CHECK(sensor("name = \"a\"\nsamples = 0\ngrid = { z = 0, cells = [1, 1] }\n") ==
        "scene.toml:7: sensor[0].samples: found 0; expected a whole number from 1 to 16777216");
}

TEST_CASE("Sensors that need a size say so when the scene has none", "[hostile][scene]") {
  const auto placed = [](const std::string& keys) {
    const SceneFiles files_of(sky + "[[sensor]]\nname = \"a\"\n" + keys, files);
    const Scene scene = files_of.read();
    return message_of(files_of.file(), [&] { place_sensors(scene, Box{}); });
  };
  CHECK(placed("grid = { z = 0, cells = [1, 1] }\n") ==
        "scene.toml: sensor.a.size: found nothing, in a scene without plants, ground or periodic cell; expected [along x, along y] [m]");
  CHECK(placed("profile = { step = 1, size = [1, 1] }\n") ==
        "scene.toml: sensor.a.profile: found no `low` or no `high`, in a scene without plants or ground; expected both [m]");
  CHECK(placed("profile = { step = 1e-6, size = [1, 1], low = 0, high = 1 }\n") ==
        "scene.toml: sensor.a.profile.step: found 1e-06 m for heights from 0 to 1; expected a step that makes at most 100000 heights");
}
