// Optics, ground, plants, groups and placements that cannot be.
#include <catch2/catch.hpp>

#include <scene_files.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

const std::string light = "bands = [\"PAR\"]\nsky = { model = \"uniform\", irradiance = { PAR = 1.0 } }\n";  // 2 lines
const std::string leaf = "[optics.leaf]\nreflectance = { PAR = 0.1 }\n";                                     // 2 lines

std::string message(const std::string& scene) {
  const std::map<std::string, std::string> files{{"two.obj", two_organs},
                                                 {"folder/x", ""},
                                                 {"empty.obj", ""},
                                                 {"bad.obj", "v 0 0 nan\nf 1 1 1\n"},
                                                 {"letters.csv", "x,y\n1,b\n"},
                                                 {"zero.csv", "# nothing\n"},
                                                 {"wide.csv", "x,y,turm\n1,2,3\n"},
                                                 {"short.csv", "x,y,z\n1,2,3\n1,2\n"},
                                                 {"nox.csv", "y,z\n1,2\n"},
                                                 {"small.csv", "1,2,0,0,0\n"},
                                                 {"inf.csv", "1,inf\n"},
                                                 {"one.csv", "1\n"}};
  return SceneFiles(light + scene, files).message();
}
std::string plant(const std::string& keys) {
  return message(leaf + "[[plant]]\nname = \"p\"\n" + keys);
}
std::string place(const std::string& keys) {
  return plant("file = \"two.obj\"\noptics = { \"*\" = \"leaf\" }\n" + keys);
}

}  // namespace

TEST_CASE("Optics that no leaf can have", "[hostile][scene]") {
  CHECK(message("[optics.leaf]\n") ==
        "scene.toml:3: optics.leaf.reflectance: found nothing; expected a reflectance per band, or `reflectance_front` and "
        "`reflectance_back`");
  CHECK(message("[optics.leaf]\ntransmittance = { PAR = 0.1 }\n") ==
        "scene.toml:3: optics.leaf.reflectance: found nothing; expected a reflectance per band, or `reflectance_front` and "
        "`reflectance_back`");
  CHECK(message("[optics.leaf]\nreflectance = {}\n") ==
        "scene.toml:4: optics.leaf.reflectance.PAR: found nothing; expected a number: every band needs one");
  CHECK(message("[optics.leaf]\nreflectance = { PAR = -0.1 }\n") ==
        "scene.toml:4: optics.leaf.reflectance.PAR: found -0.1; expected a number from 0 to 1");
  CHECK(message("[optics.leaf]\nreflectance = { PAR = 1.1 }\n") ==
        "scene.toml:4: optics.leaf.reflectance.PAR: found 1.1; expected a number from 0 to 1");
  CHECK(message("[optics.leaf]\nreflectance = { PAR = 0.6 }\ntransmittance = { PAR = 0.5 }\n") ==
        "scene.toml:4: optics.leaf.reflectance.PAR: found reflectance 0.6 + transmittance 0.5 = 1.1; expected a sum of at most 1");
  CHECK(message("[optics.leaf]\nreflectance_front = { PAR = 0.5 }\nreflectance_back = { PAR = 0.6 }\ntransmittance = { PAR = 0.5 }\n") ==
        "scene.toml:5: optics.leaf.reflectance_back.PAR: found reflectance 0.6 + transmittance 0.5 = 1.1; expected a sum of at most 1");
  CHECK(message("[optics.leaf]\nreflectance_front = { PAR = 0.5 }\n") ==
        "scene.toml:3: optics.leaf.reflectance_back: found nothing; expected a reflectance per band, as `reflectance_front` is given");
  CHECK(message("[optics.leaf]\nreflectance = { PAR = 0.5 }\nreflectance_back = { PAR = 0.5 }\n") ==
        "scene.toml:5: optics.leaf.reflectance_back: found a value beside `reflectance`; expected either `reflectance`, or both of "
        "`reflectance_front` and `reflectance_back`");
  CHECK(message("[optics.leaf]\nreflectance = { PAR = nan }\n") ==
        "scene.toml:4: optics.leaf.reflectance.PAR: found nan; expected a finite number");
  CHECK(message("optics = 3\n") == "scene.toml:3: optics: found 3; expected a table");
}

TEST_CASE("Ground that cannot be", "[hostile][scene]") {
  const std::string soil = "reflectance = { PAR = 0.1 }\n", cell = "domain = { periodic = [0, 0, 2, 1] }\n";
  CHECK(message("[ground]\nsize = [1, 1]\n") == "scene.toml:3: ground.reflectance: found nothing; expected a reflectance per band");
  CHECK(message("[ground]\n" + soil) == "scene.toml:3: ground.size: found nothing; expected [width, depth] of the ground [m]");
  CHECK(message("[ground]\nsize = [1, 0]\n" + soil) == "scene.toml:4: ground.size: found [1, 0]; expected two lengths above zero [m]");
  CHECK(message("[ground]\nsize = [1, 1]\ncells = [0, 1]\n" + soil) ==
        "scene.toml:5: ground.cells[0]: found 0; expected a whole number from 1 to 30000");
  CHECK(message("[ground]\nsize = [1, 1]\ncells = 4\n" + soil) ==
        "scene.toml:5: ground.cells: found 4; expected an array of 2 whole numbers: cells along x, cells along y");
  CHECK(message("[ground]\nsize = [1, 1]\nreflectance = { PAR = 1.5 }\n") ==
        "scene.toml:5: ground.reflectance.PAR: found 1.5; expected a number from 0 to 1");
  CHECK(message("[ground]\nmesh = \"no.ply\"\n" + soil) ==
        "scene.toml:4: ground.mesh: found no file \"no.ply\"; expected a mesh file (its path is relative to the scene file)");
  CHECK(message("[ground]\nmesh = \"two.obj\"\nsize = [1, 1]\n" + soil) ==
        "scene.toml:5: ground.size: found `size` beside `mesh`; expected one of them: the mesh has its own");
  CHECK(message("[ground]\nsize = [1, 1]\nunit = \"cm\"\n" + soil) ==
        "scene.toml:5: ground.unit: found `unit` without `mesh`; expected no unit: lengths of the scene are metres");
  CHECK(message(cell + "[ground]\nsize = [1, 1]\n" + soil) ==
        "scene.toml:4: ground: found ground from (0.5, 0) to (1.5, 1); expected ground that fills the periodic cell, (0, 0) to (2, 1)");
  CHECK(message(cell + "[ground]\ncenter = [0, 0]\n" + soil) ==
        "scene.toml:4: ground: found ground from (-1, -0.5) to (1, 0.5); expected ground that fills the periodic cell, (0, 0) to (2, 1)");
  CHECK(message(cell + "[ground]\nmesh = \"two.obj\"\n" + soil) ==
        "scene.toml:5: ground.mesh: found ground from (0, 0) to (1, 1); expected ground that fills the periodic cell, (0, 0) to (2, 1)");
}

TEST_CASE("Plants that cannot be read", "[hostile][scene]") {
  const std::string all = "optics = { \"*\" = \"leaf\" }\n";
  CHECK(message(leaf + "[[plant]]\nfile = \"two.obj\"\n") == "scene.toml:5: plant[0].name: found nothing; expected a name");
  CHECK(plant(all) == "scene.toml:5: plant[0].file: found nothing; expected the plant's file");
  CHECK(plant("file = \"none.obj\"\n" + all) ==
        "scene.toml:7: plant[0].file: found no file \"none.obj\"; expected a plant file (its path is relative to the scene file)");
  CHECK(plant("file = \"folder\"\n" + all) == "scene.toml:7: plant[0].file: found a folder, \"folder\"; expected a plant file");
  CHECK(plant("file = \"empty.obj\"\n" + all) == "empty.obj: found no face; expected at least one triangle or polygon");
  CHECK(plant("file = \"bad.obj\"\n" + all) == "bad.obj:1: found a vertex coordinate \"nan\"; expected a finite number");
  CHECK(plant("file = \"two.obj\"\nunit = \"centimetre\"\n" + all) ==
        "scene.toml:8: plant[0].unit: found \"centimetre\"; expected one of m, cm, mm, inch, foot");
  CHECK(plant("file = \"two.obj\"\npolicy = \"none.toml\"\n" + all) ==
        "scene.toml:8: plant[0].policy: found no file \"none.toml\"; expected a policy file (its path is relative to the scene file)");
  CHECK(plant("file = \"two.obj\"\n") ==
        "scene.toml:5: plant[0].optics: found nothing; expected which optics its organs have, like { Leaf = \"leaf\", \"*\" = \"bark\" }");
  CHECK(plant("file = \"two.obj\"\noptics = { a = \"leaf\" }\n") ==
        "scene.toml:8: plant[0].optics: found no optics for type \"organ\", material \"n\" (such as \"b\"); expected a key that is the "
        "type, material or name of each, or \"*\" for the rest");
  CHECK(plant("file = \"two.obj\"\noptics = { a = \"leaff\", \"*\" = \"leaf\" }\n") ==
        "scene.toml:8: plant[0].optics.a: found \"leaff\"; expected one of leaf; did you mean \"leaf\"?");
  CHECK(plant("file = \"two.obj\"\noptics = {}\n") ==
        "scene.toml:8: plant[0].optics: found no optics for type \"organ\", material \"m\" (such as \"a\"); type \"organ\", material \"n\" "
        "(such as \"b\"); expected a key that is the type, material or name of each, or \"*\" for the rest");
  CHECK(message("[[plant]]\nname = \"p\"\nfile = \"two.obj\"\noptics = { \"*\" = \"leaf\" }\n") ==
        "scene.toml:6: plant[0].optics.*: found \"leaf\"; expected an optics name: the scene has no [optics.NAME]");
  CHECK(place("[[plant]]\nname = \"p\"\nfile = \"two.obj\"\noptics = { \"*\" = \"leaf\" }\n") ==
        "scene.toml:10: plant[1].name: found \"p\" twice; expected a name of its own for every plant and group");
  CHECK(message(leaf + "[[plant]]\nname = \"p/q\"\n") ==
        "scene.toml:6: plant[0].name: found \"p/q\"; expected a name without \"/\", which separates the parts of a placement's path");
}

TEST_CASE("Species take an age and a seed, other plants a unit", "[hostile][scene]") {
  const std::string all = "optics = { \"*\" = \"leaf\" }\n";
  const std::string maize = "file = \"" + std::string(SUNFLECK_SOURCE_DIR) + "/plants/maize.toml\"\n" + all;
  CHECK(plant("file = \"two.obj\"\nage = 3\n" + all) ==
        "scene.toml:8: plant[0].age: found `age` beside a file that is no species .toml; expected it with species only");
  CHECK(plant("file = \"two.obj\"\nseed = 3\n" + all) ==
        "scene.toml:8: plant[0].seed: found `seed` beside a file that is no species .toml; expected it with species only");
  CHECK(plant(maize + "unit = \"cm\"\n") ==
        "scene.toml:9: plant[0].unit: found `unit` beside a species; expected none: species grow in metres");
  CHECK(plant(maize + "age = -1\n") == "scene.toml:9: plant[0].age: found -1; expected a number above zero");
  CHECK(plant(maize + "seed = 0.5\n") == "scene.toml:9: plant[0].seed: found 0.5; expected a whole number of at least 0");
}

TEST_CASE("Placements that cannot be", "[hostile][scene]") {
  CHECK(place("place = [ { turn = 3 } ]\n") ==
        "scene.toml:9: plant[0].place[0].position: found nothing; expected [x, y, z] [m], or `grid`, or `file`");
  CHECK(place("place = [ { position = [0, 0] } ]\n") ==
        "scene.toml:9: plant[0].place[0].position: found an array of 2; expected an array of 3 numbers: x, y, z [m]");
  CHECK(place("place = [ { position = [0, 0, inf] } ]\n") ==
        "scene.toml:9: plant[0].place[0].position[2]: found inf; expected a finite number");
  CHECK(place("place = [ { position = [0, 0, 0], scale = 0 } ]\n") ==
        "scene.toml:9: plant[0].place[0].scale: found 0; expected a number above zero");
  CHECK(place("place = [ { position = [0, 0, 0], turn = \"random\" } ]\n") ==
        "scene.toml:9: plant[0].place[0].turn: found \"random\"; expected a number");
  CHECK(place("place = [ { position = [0, 0, 0], tilt = 200 } ]\n") ==
        "scene.toml:9: plant[0].place[0].tilt: found 200; expected a number from 0 to 180 degrees");
  CHECK(place("place = [ { position = [0, 0, 0], mirror = 1 } ]\n") ==
        "scene.toml:9: plant[0].place[0].mirror: found 1; expected true or false");
  CHECK(place("place = [ 3 ]\n") == "scene.toml:9: plant[0].place[0]: found 3; expected a table");
  CHECK(place("place = [ { grid = { step = [1, 1] } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.count: found nothing; expected [copies along x, copies along y]");
  CHECK(place("place = [ { grid = { count = [1, 1] } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.step: found nothing; expected [along x, along y] between copies [m]");
  CHECK(place("place = [ { grid = { step = [1, 1], count = [0, 1] } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.count[0]: found 0; expected a whole number from 1 to 1000000");
  CHECK(place("place = [ { grid = { step = [1, 1], count = [100000, 100000] } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.count: found 10000000000 copies; expected at most 10000000 in one grid (a group may hold "
        "many)");
  CHECK(place("place = [ { grid = { step = [1, 1], count = [1, 1], turn = \"rand\" } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.turn: found \"rand\"; expected a number of degrees, or \"random\"");
  CHECK(place("place = [ { grid = { step = [1, 1], count = [1, 1], seed = 2 } } ]\n") ==
        "scene.toml:9: plant[0].place[0].grid.seed: found `seed` without turn = \"random\"; expected both or neither");
  CHECK(place("place = [ { grid = { step = [1, 1], count = [1, 1] }, scale = 2 } ]\n") ==
        "scene.toml:9: plant[0].place[0].scale: found `scale` beside `grid`; expected it inside `grid`");
  CHECK(place("place = [ { file = \"letters.csv\" } ]\n") == "letters.csv:2: y: found \"b\"; expected a finite number");
  CHECK(place("place = [ { file = \"zero.csv\" } ]\n") ==
        "zero.csv: found no position; expected at least one line of x, y, z, turn, scale");
  CHECK(place("place = [ { file = \"wide.csv\" } ]\n") ==
        "wide.csv:1: found column \"turm\"; expected one of x, y, z, turn, scale, tilt, tilt_azimuth, mirror; did you mean \"turn\"?");
  CHECK(place("place = [ { file = \"short.csv\" } ]\n") == "short.csv:3: found 2 cells; expected 3, as in the first line");
  CHECK(place("place = [ { file = \"nox.csv\" } ]\n") == "nox.csv:1: found no column \"x\"; expected at least x and y [m]");
  CHECK(place("place = [ { file = \"small.csv\" } ]\n") == "small.csv:1: scale: found 0; expected a number above zero");
  CHECK(place("place = [ { file = \"inf.csv\" } ]\n") == "inf.csv:1: y: found \"inf\"; expected a finite number");
  CHECK(place("place = [ { file = \"one.csv\" } ]\n") == "one.csv:1: found 1 numbers; expected 2 to 5: x, y, z, turn, scale");
  CHECK(place("place = [ { file = \"none.csv\" } ]\n") ==
        "scene.toml:9: plant[0].place[0].file: found no file \"none.csv\"; expected a CSV file with columns x, y, z, turn, scale (its path "
        "is relative to the scene file)");
  CHECK(place("place = []\ngrid = { step = [1, 1], count = [1, 1] }\n") ==
        "scene.toml:10: plant[0].grid: found `grid` beside `place`; expected one of them");
}

TEST_CASE("Groups that cannot be", "[hostile][scene]") {
  CHECK(place("[[group]]\nname = \"tile\"\n") ==
        "scene.toml:9: group[0].place: found nothing; expected its members, like [ { plant = \"NAME\", position = [0, 0, 0] } ]");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = []\n") ==
        "scene.toml:11: group[0].place: found an empty array; expected at least one member");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = [ { plant = \"coffe\", position = [0, 0, 0] } ]\n") ==
        "scene.toml:11: group[0].place[0].plant: found \"coffe\"; expected one of p");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = [ { position = [0, 0, 0] } ]\n") ==
        "scene.toml:11: group[0].place[0]: found neither `plant` nor `group`; expected one of them");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = [ { plant = \"p\", group = \"tile\", position = [0, 0, 0] } ]\n") ==
        "scene.toml:11: group[0].place[0]: found both `plant` and `group`; expected one of them");
  CHECK(place("[[group]]\nname = \"p\"\nplace = [ { plant = \"p\", position = [0, 0, 0] } ]\n") ==
        "scene.toml:10: group[0].name: found \"p\" twice; expected a name of its own for every plant and group");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = [ { group = \"tile\", position = [0, 0, 0] } ]\n") ==
        "scene.toml:9: group[0]: found a group that holds itself: \"tile\" -> \"tile\"; expected groups without a circle");
  CHECK(place("[[group]]\nname = \"tile\"\nplace = [ { group = \"row\", position = [0, 0, 0] } ]\n[[group]]\nname = \"row\"\nplace = [ { "
              "plant = \"p\", position = [0, 0, 0] }, "
              "{ group = \"stand\", position = [0, 0, 0] } ]\n[[group]]\nname = \"stand\"\nplace = [ { group = \"row\", position = [0, 0, "
              "0] } ]\n") ==
        "scene.toml:12: group[1]: found a group that holds itself: \"row\" -> \"stand\" -> \"row\"; expected groups without a circle");
  CHECK(place("[[place]]\ngroup = \"tile\"\nposition = [0, 0, 0]\n") ==
        "scene.toml:10: place[0].group: found \"tile\"; expected a group: the scene has none");
  CHECK(place("[[place]]\nposition = [0, 0, 0]\n") == "scene.toml:9: place[0]: found neither `plant` nor `group`; expected one of them");
}
