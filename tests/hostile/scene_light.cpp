// Suns, skies and states that cannot be.
#include <catch2/catch.hpp>

#include <scene_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const std::string& light) {
  return SceneFiles("bands = [\"PAR\"]\n" + light).message();
}
std::string sun(const std::string& keys) {
  return message("[sun]\n" + keys + "irradiance = { PAR = 100 }\n");
}

}  // namespace

TEST_CASE("A scene needs light", "[hostile][scene]") {
  CHECK(message("") == "scene.toml: found no light; expected [sun], [sky], [[lamp]], or any number of [[state]]");
  CHECK(message("state = []\n") == "scene.toml:2: state: found an empty array; expected at least one state");
  CHECK(message("[[state]]\nname = \"noon\"\n") == "scene.toml:2: state[0]: found no light; expected `sun`, `sky` or both");
  CHECK(
      message(
          "[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 1 }\n[[state]]\nsky = { model = \"uniform\", irradiance = { PAR = 1 } }\n") ==
      "scene.toml:2: sun: found [sun] beside [[state]]; expected one of them: each [[state]] has its own light");
  CHECK(message("[[state]]\nname = \"a\"\nsky = { model = \"uniform\", irradiance = { PAR = 1 } }\n[[state]]\nname = \"a\"\nsky = { model "
                "= \"uniform\", irradiance = { PAR = 1 } }\n") ==
        "scene.toml:6: state[1].name: found the name \"a\" twice; expected a name for every state");
  CHECK(message("[[state]]\nduration_s = -1\nsky = { model = \"uniform\", irradiance = { PAR = 1 } }\n") ==
        "scene.toml:3: state[0].duration_s: found -1; expected a number of zero or more seconds");
}

TEST_CASE("The sun's place is given once and whole", "[hostile][scene]") {
  CHECK(sun("direction = [0, 0, 0]\n") ==
        "scene.toml:3: sun.direction: found [0, 0, 0]; expected a vector towards the sun that is not zero");
  CHECK(sun("direction = [0, 1]\n") ==
        "scene.toml:3: sun.direction: found an array of 2; expected an array of 3 numbers: x (east), y (north), z (up), towards the sun");
  CHECK(sun("direction = [0, nan, 1]\n") == "scene.toml:3: sun.direction[1]: found nan; expected a finite number");
  CHECK(sun("") ==
        "scene.toml:2: sun: found no position of the sun; expected one of: `direction`; `elevation` and `azimuth`; `latitude`, `longitude` "
        "and `time`");
  CHECK(sun("direction = [0, 0, 1]\nelevation = 30\n") ==
        "scene.toml:2: sun: found several positions of the sun; expected one of: `direction`; `elevation` and `azimuth`; `latitude`, "
        "`longitude` and `time`");
  CHECK(sun("elevation = 30\n") ==
        "scene.toml:2: sun.azimuth: found nothing; expected the sun's angle from north over east [degrees], as `elevation` is given");
  CHECK(sun("elevation = 91\nazimuth = 0\n") == "scene.toml:3: sun.elevation: found 91; expected a number from -90 to 90 degrees");
  CHECK(sun("latitude = 43\nlongitude = 3\n") ==
        "scene.toml:2: sun.time: found nothing; expected all of `latitude`, `longitude` and `time`");
  CHECK(sun("latitude = 95\nlongitude = 3\ntime = \"2026-06-21T12:00:00Z\"\n") ==
        "scene.toml:3: sun.latitude: found 95; expected a number from -90 to 90 degrees");
  CHECK(sun("latitude = 43\nlongitude = 3\ntime = \"2026-06-21 noon\"\n") ==
        "scene.toml:5: sun.time: found \"2026-06-21 noon\"; expected a time that exists, in ISO 8601 with its zone, such as "
        "\"2026-06-21T09:00:00+02:00\" or \"2026-06-21T07:00:00Z\"");
  CHECK(sun("latitude = 43\nlongitude = 3\ntime = 2026-06-21T12:00:00\n") ==
        "scene.toml:5: sun.time: found \"2026-06-21T12:00:00\"; expected a time that exists, in ISO 8601 with its zone, such as "
        "\"2026-06-21T09:00:00+02:00\" or \"2026-06-21T07:00:00Z\"");
  CHECK(sun("latitude = 43\nlongitude = 3\ntime = 2026-06-21\n") ==
        "scene.toml:5: sun.time: found 2026-06-21; expected a date and time with its zone, like \"2026-06-21T09:00:00+02:00\"");
  CHECK(sun("latitude = 43\nlongitude = 3\ntime = \"2026-02-30T12:00:00Z\"\n") ==
        "scene.toml:5: sun.time: found \"2026-02-30T12:00:00Z\"; expected a time that exists, in ISO 8601 with its zone, such as "
        "\"2026-06-21T09:00:00+02:00\" or \"2026-06-21T07:00:00Z\"");
  CHECK(sun("direction = [0, 0, 1]\nangular_diameter = -1\n") ==
        "scene.toml:4: sun.angular_diameter: found -1; expected a number from 0 to 90 degrees");
  CHECK(message("[sun]\ndirection = [0, 0, 1]\n") ==
        "scene.toml:2: sun.irradiance: found nothing; expected the irradiance per band, on a plane that faces the sun");
  CHECK(message("[sun]\ndirection = [0, 0, 1]\nirradiance = {}\n") ==
        "scene.toml:4: sun.irradiance.PAR: found nothing; expected a number: every band needs one");
}

TEST_CASE("Skies that this version does not know are refused by name", "[hostile][scene]") {
  CHECK(message("[sky]\nmodel = \"perez\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:3: sky.model: found \"perez\", which this version does not support; expected one of uniform, standard_overcast, clear, "
        "file, "
        "sphere");
  CHECK(message("[sky]\nmodel = \"unifrom\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:3: sky.model: found \"unifrom\"; expected one of uniform, standard_overcast, clear, file, sphere; did you mean "
        "\"uniform\"?");
  CHECK(message("[sky]\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:2: sky.model: found nothing; expected one of uniform, standard_overcast, clear, file, sphere");
  CHECK(message("[sky]\nmodel = \"uniform\"\n") ==
        "scene.toml:2: sky.irradiance: found nothing; expected the irradiance per band, on an unobstructed horizontal plane");
  CHECK(message("[sky]\nmodel = \"clear\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:3: sky.model: found a clear sky without a sun; expected a sun above the horizon, about which the clear sky is built");
  CHECK(message("[sun]\ndirection = [1, 0, -0.1]\nirradiance = { PAR = 1 }\n[sky]\nmodel = \"clear\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:6: sky.model: found a clear sky with the sun below the horizon; expected a sun above the horizon, about which the "
        "clear sky is built");
}

TEST_CASE("Global radiation needs all that its split takes", "[hostile][scene]") {
  const std::string sky = "[sky]\nmodel = \"uniform\"\n", day = "[sun]\nelevation = 40\nazimuth = 180\n";
  CHECK(message("[global]\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:2: global: found `global` without `sun`; expected a sun with its position and a sky with its model, between which it "
        "is split");
  CHECK(message(day + "[global]\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:5: global: found `global` without `sky`; expected a sun with its position and a sky with its model, between which it "
        "is split");
  CHECK(message(day + sky + "[global]\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:7: global.day: found nothing; expected the day of the year from 1 to 366, or a sun with `time`");
  CHECK(message(day + sky + "[global]\nday = 400\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:8: global.day: found 400; expected a whole number from 1 to 366");
  CHECK(message(day + sky + "[global]\nday = 100\n") ==
        "scene.toml:7: global.irradiance: found nothing; expected the global irradiance per band, on a horizontal plane");
  CHECK(message(day + sky + "irradiance = { PAR = 1 }\n[global]\nday = 100\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:7: sky.irradiance: found `irradiance` beside `global`; expected one of them: `global` is split into sun and sky");
  CHECK(message(day + "irradiance = { PAR = 1 }\n" + sky + "[global]\nday = 100\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:5: sun.irradiance: found `irradiance` beside `global`; expected one of them: `global` is split into sun and sky");
  CHECK(message("units = { PAR = \"umol m-2 s-1\" }\n" + day + sky + "[global]\nday = 100\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:8: global.shortwave: found nothing; expected the global radiation of all wavelengths [W m^-2], as band \"PAR\" counts "
        "photons");
  CHECK(message("[sun]\nlatitude = 43\nlongitude = 3\ntime = \"2026-06-21T12:00:00Z\"\n" + sky +
                "[global]\nday = 100\nirradiance = { PAR = 400 }\n") ==
        "scene.toml:9: global.day: found `day` beside the sun's `time`; expected one date");
}

TEST_CASE("A sky of directions is refused with file, line and key", "[hostile][scene][sky]") {
  const auto sky = [](const std::string& keys, const std::string& csv = "") {
    const SceneFiles files("bands = [\"PAR\"]\n[sky]\nmodel = \"file\"\nirradiance = { PAR = 1 }\n" + keys, {{"sky.csv", csv}});
    return files.message();
  };
  CHECK(sky("") ==
        "scene.toml:2: sky: found neither `file` nor `directions`; expected one of them, with the directions and radiances of the sky");
  CHECK(sky("file = \"sky.csv\"\ndirections = [[0, 0, 1, 1]]\n").find("scene.toml:2: sky: found both `file` and `directions`") == 0);
  CHECK(sky("directions = [[0, 0, 1]]\n").find("scene.toml:5: sky.directions[0]: found an array of 3; expected an array of 4 numbers") ==
        0);
  CHECK(sky("directions = [[0, 0, -1, 1]]\n") ==
        "scene.toml:5: sky.directions[0]: found [0, 0, -1]; expected a direction at or above the horizon");
  CHECK(sky("directions = [[0, 0, 1, 0]]\n") ==
        "scene.toml:5: sky.directions: found radiances that are all zero; expected at least one above zero");
  const std::string file = "file = \"sky.csv\"\n";
  CHECK(sky(file, "x,y,z,radiance\n0,0,1,1\n0.5,0,0.5,2 # warm\n") == "");
  CHECK(sky(file,
            "\xEF\xBB\xBF"
            "elevation,azimuth,radiance\n90,0,1\n30,180,2\n") == "");
  CHECK(sky(file, "") ==
        "sky.csv: found no direction; expected a header and rows of x, y, z (towards the sky) or elevation, azimuth (from north "
        "over east) [degrees], and radiance");
  CHECK(sky(file, "0,0,1,1\n").find("sky.csv:1: found column \"0\"; expected each once of x, y, z") == 0);
  CHECK(sky(file, "x,y,radiance\n0,0,1\n").find("sky.csv:1: found no column z") == 0);
  CHECK(sky(file, "x,y,z,radiance\n0,0,1\n") == "sky.csv:2: found 3 cells; expected 4, as in the first line");
  CHECK(sky(file, "elevation,azimuth,radiance\n95,0,1\n") == "sky.csv:2: found elevation 95; expected 0 to 90 degrees");
  CHECK(sky(file, "x,y,z,radiance\n0,0,1,-1\n") == "sky.csv:2: found radiance -1; expected zero or more");
  CHECK(message("[sky]\nmodel = \"uniform\"\nfile = \"sky.csv\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:4: sky.file: found `file` beside model = \"uniform\"; expected model = \"file\"");
}
