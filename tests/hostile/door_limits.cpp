// Numbers and names that no output could hold are refused before anything is computed, for scenes from files and from memory.
#include <catch2/catch.hpp>

#include <cmath>

#include <run_program.hpp>
#include <sunfleck/core/error.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>

#include "scene_files.hpp"

using namespace sunfleck;

namespace {

const std::string leaf = "g leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

struct Parts {
  std::string bands = "\"PAR\"", sun = "direction = [0, 0, 1]\nirradiance = { PAR = 10.0 }", place = "{ position = [0, 0, 0] }",
              name = "leaf", more = "", obj = leaf, state = "";
};

std::string message(const Parts& p) {
  const SceneFiles scene("bands = [" + p.bands + "]\n" + (p.state.empty() ? "[sun]\n" + p.sun + "\n" : p.state) +
                             "[optics.l]\nreflectance = { PAR = 0.1 }\n[[plant]]\nname = \"" + p.name +
                             "\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"l\" }\nplace = [ " + p.place + " ]\n" + p.more,
                         {{"leaf.obj", p.obj}});
  return scene.message();
}

bool says(const std::string& text, const std::string& part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Coordinates beyond what single precision and a planet hold are refused at the door", "[hostile][limits]") {
  CHECK(message({}) == "");
  CHECK(says(message({.place = "{ position = [0, 0, 1e9] }"}),
             "scene.toml: plant[0].place[0]: found parts as far as 1e+09 m from the origin"));
  CHECK(says(message({.place = "{ position = [0, 0, 0], scale = 1e300 }"}), "plant[0].place[0]: found parts as far as"));
  CHECK(says(message({.place = "{ grid = { step = [1e300, 1], count = [2, 1] } }"}), "plant[0].place[1]: found parts as far as"));
  CHECK(says(message({.obj = "g leaf\nv 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n"}), "leaf.obj: found parts as far as inf m"));
  CHECK(says(message({.obj = "g leaf\nv 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n"}), "leaf.obj: found parts as far as 1e+39 m"));
  CHECK(message({.obj = "g leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e39 0 0\nf 1 2 3\n"}) == "");  // of no face
  for (const char* more :
       {"[[sensor]]\nname = \"s\"\ngrid = { z = -1e308, cells = [5, 5], size = [1, 1] }\n",
        "[[sensor]]\nname = \"s\"\ngrid = { z = 1.0, cells = [5, 5], size = [1e18, 1e18] }\n",
        "[[sensor]]\nname = \"s\"\ngrid = { z = 1.0, cells = [5, 5], size = [1, 1], center = [1e39, 0] }\n",
        "[[sensor]]\nname = \"s\"\nprofile = { low = 0.0, high = 1e300, step = 1e299, size = [1, 1] }\n",
        "[ground]\nsize = [1e39, 1]\nreflectance = { PAR = 0.1 }\n",
        "[ground]\nsize = [1, 1]\nheight = -1e39\nreflectance = { PAR = 0.1 }\n",
        "[ground]\nsize = [1, 1]\ncenter = [1e39, 0]\nreflectance = { PAR = 0.1 }\n", "[domain]\nperiodic = [-1e30, 0, 1e30, 1]\n",
        "[[lamp]]\nmesh = \"leaf.obj\"\npower = { PAR = 1 }\nplace = [ { position = [1e30, 0, 0] } ]\n",
        "[[group]]\nname = \"g\"\nplace = [ { plant = \"leaf\", position = [9e7, 0, 0] } ]\n[[place]]\ngroup = \"g\"\nposition = [9e7, 0, "
        "0]\n"}) {
    INFO(more);
    const std::string text = message({.more = more});
    INFO(text);
    CHECK((says(text, "1e+08 m") || says(text, "2e+08 m")));
  }
  // a plant far from its own origin that is brought back is fine
  CHECK(message({.place = "{ position = [-1e7, 0, 0] }", .obj = "g leaf\nv 1e7 0 0\nv 10000001 0 0\nv 1e7 1 0\nf 1 2 3\n"}) == "");
}

TEST_CASE("The same for a scene made in memory, where nothing is a number either", "[hostile][limits]") {
  const auto scene_with = [](const Vec3& p, double irradiance) {
    Scene scene;
    scene.bands = {"PAR"};
    scene.band_units = {"W m^-2"};
    LightState state;
    state.sun = Sun{{0, 0, 1}, {irradiance}, 0.0};
    scene.states = {state};
    scene.optics.push_back({"leaf", {0.1f}, {0.1f}, {0.0f}});
    scene.plants.push_back(
        {"leaf", std::make_shared<const Plant>(make_plant(Mesh{{{0, 0, 0}, {1, 0, 0}, p}, {{0, 1, 2}}})), {0}, "", {{Affine{}}}});
    return scene;
  };
  CHECK_NOTHROW(check_scene(scene_with({0, 1, 0}, 10)));
  CHECK_THROWS_WITH(check_scene(scene_with({0, 1e39, 0}, 10)), Catch::Contains("plant[0]: found parts as far as 1e+39 m"));
  CHECK_THROWS_WITH(check_scene(scene_with({0, 1, 0}, 1e308)),
                    Catch::Contains("state[0].sun.irradiance.PAR: found 1e+308; expected at most 1e+12"));
}

TEST_CASE("Light beyond measure is refused with its key", "[hostile][limits]") {
  CHECK(message({.sun = "direction = [0, 0, 1]\nirradiance = { PAR = 1e308 }"}) ==
        "scene.toml:4: sun.irradiance.PAR: found 1e+308; expected at most 1e+12");
  CHECK(says(message({.more = "[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1e20 }\n"}),
             "sky.irradiance.PAR: found 1e+20; expected at most"));
  CHECK(says(message({.more = "[[lamp]]\nmesh = \"leaf.obj\"\nexitance = { PAR = 1e300 }\n"}),
             "exitance.PAR: found 1e+300; expected at most 1e+12"));
  CHECK(says(message({.state = "[[state]]\nduration_s = 1e300\nsun = { direction = [0, 0, 1], irradiance = { PAR = 1 } }\n"}),
             "duration_s: found 1e+300; expected at most 1e+10 seconds"));
}

TEST_CASE("Names with control characters, and what would be taken for the ground, are refused at the door", "[hostile][limits]") {
  CHECK(says(message({.name = "a\\nb"}), "plant[0].name: found \"a b\" with a control character; expected a name on one line of text"));
  CHECK(says(message({.more = "[[sensor]]\nname = \"a\\u0000b\"\ngrid = { z = 1.0, cells = [1, 1], size = [1, 1] }\n"}),
             "sensor[0].name: found \"a b\" with a control character"));
  CHECK(says(message({.bands = "\"PAR\\n\"", .sun = "direction = [0, 0, 1]\nirradiance = { \"PAR\\n\" = 1.0 }"}), "scene.toml"));
  CHECK(says(message({.state = "[[state]]\nname = \"a\\u0085\"\nsun = { direction = [0, 0, 1], irradiance = { PAR = 1 } }\n"}),
             "state[0].name: found"));
  const std::string ground = "[ground]\nsize = [1, 1]\nreflectance = { PAR = 0.1 }\n";
  CHECK(message({.name = "ground"}) == "");
  CHECK(says(message({.name = "ground", .more = ground}),
             "plant[0].name: found \"ground\"; expected another name: results call the scene's ground so"));
  CHECK(says(message({.more = ground + "[[group]]\nname = \"ground\"\nplace = [ { plant = \"leaf\", position = [0, 0, 0] } ]\n"}),
             "group[0].name: found \"ground\""));
}

TEST_CASE("Dotted keys do not nest without bound", "[hostile][limits]") {
  std::string key = "a";
  for (int i = 0; i < 40000; ++i) key += ".a";
  CHECK(message({.more = key + " = 1\n"}) ==
        "scene.toml:12: found a key of more than 32 parts between dots; expected keys of this format, which have a few");
  CHECK(says(message({.more = "[" + key + "]\n"}), "scene.toml:12: found a key of more than 32 parts"));
  CHECK(says(message({.more = "[[" + key + "]]\n"}), "scene.toml:12: found a key of more than 32 parts"));
  CHECK(says(message({.more = "x = { " + key + " = 1 }\n"}), "scene.toml:12: found a key of more than 32 parts"));
  std::string dots(100, '.'), numbers = "0.5";
  for (int i = 0; i < 100; ++i) numbers += ", 0.5";
  CHECK(says(message({.more = "# " + dots + "\n[solve]\nmethod = \"" + dots + "\"\n"}), "solve.method"));
  CHECK(says(message({.more = "[solve]\nseed = [" + numbers + "]\nmethod = '''\n" + dots + "'''\n"}), "scene.toml:1"));
}

TEST_CASE("The program ends with 2 and says where", "[cli][hostile][limits]") {
  const TemporaryFolder folder;
  folder.file("leaf.obj", leaf);
  const auto scene =
      folder.file("scene.toml",
                  "bands = [\"PAR\"]\n[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 10.0 }\n[optics.l]\nreflectance = { "
                  "PAR = 0.1 }\n[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"l\" }\nplace = [ { position = [0, 0, "
                  "1e9] } ]\n[domain]\nperiodic = [-1, -1, 1, 1]\n");
  for (const std::string method : {"instantiation", "clustering", "flat", "direct", "reference"}) {
    const auto run = run_sunfleck({"solve", scene, "-o", folder.path("r.h5"), "--method", method});
    CHECK(run.exit_code == 2);
    CHECK(says(run.err, "plant[0].place[0]: found parts as far as 1e+09 m from the origin; expected coordinates from -1e+08 to 1e+08 m"));
  }
}
