// Suns, skies and states that cannot be.
#include <catch2/catch.hpp>

#include <picture_files.hpp>
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
  CHECK(message("[sky]\nmodel = \"unifrom\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:3: sky.model: found \"unifrom\"; expected one of uniform, standard_overcast, clear, perez, file, image, sphere; did "
        "you mean "
        "\"uniform\"?");
  CHECK(message("[sky]\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:2: sky.model: found nothing; expected one of uniform, standard_overcast, clear, perez, file, image, sphere");
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

TEST_CASE("Weather that is none is refused with file, line and key", "[hostile][scene][sky]") {
  const auto perez = [](const std::string& keys,
                        const std::string& before = "[sun]\nelevation = 40\nazimuth = 9\nirradiance = { PAR = 1 }\n") {
    return message(before + "[sky]\nmodel = \"perez\"\nirradiance = { PAR = 1 }\n" + keys);
  };
  CHECK(perez("clearness = 2\n") == "scene.toml:6: sky.brightness: found nothing; expected a number above 0, as `clearness` is given");
  CHECK(perez("clearness = 0.9\nbrightness = 0.1\n") == "scene.toml:9: sky.clearness: found 0.9; expected a number from 1 to 1000000");
  CHECK(perez("clearness = 1.9\nbrightness = 0\n") == "scene.toml:10: sky.brightness: found 0; expected a number above 0");
  CHECK(perez("clearness = nan\nbrightness = 0.1\n").find("scene.toml:9: sky.clearness: found nan; expected a") == 0);
  CHECK(perez("direct = 100\n") ==
        "scene.toml:6: sky.diffuse: found nothing; expected the sky's light on a horizontal plane [W m^-2], as `direct` is given");
  CHECK(perez("direct = 100\ndiffuse = 0\n") == "scene.toml:10: sky.diffuse: found 0; expected a number above 0");
  CHECK(perez("direct = 100\nclearness = 2\n").find("scene.toml:6: sky: found several kinds of weather; expected one of: `clearness`") ==
        0);
  CHECK(
      perez("", "[sun]\nelevation = -4\nazimuth = 9\nirradiance = { PAR = 1 }\n") ==
      "scene.toml:7: sky.model: found a perez sky with the sun below the horizon; expected a sun above the horizon, about which the perez "
      "sky is built");
  CHECK(perez("", "") ==
        "scene.toml:3: sky.model: found a perez sky without a sun; expected a sun above the horizon, about which the perez sky is built");
  CHECK(perez("", "units = { PAR = \"umol m-2 s-1\" }\n[sun]\nelevation = 40\nazimuth = 9\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:7: sky.direct: found nothing; expected `direct` and `diffuse` of all wavelengths [W m^-2], as a band counts photons");
  CHECK(message("[sky]\nmodel = \"uniform\"\nclearness = 2\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:4: sky.clearness: found `clearness` beside model = \"uniform\"; expected model = \"perez\"");
}

TEST_CASE("Pictures that are no skies are refused with the file, and scenes with line and key", "[hostile][scene][sky]") {
  const auto picture = [](const std::string& bytes, const std::string& keys = "", const std::string& before = "") {
    const SceneFiles files(
        "bands = [\"PAR\"]\n" + before + "[sky]\nmodel = \"image\"\nirradiance = { PAR = 1 }\nfile = \"sky.hdr\"\n" + keys,
        {{"sky.hdr", bytes}});
    return files.message();
  };
  const std::string hdr = hdr_bytes(64, 32, [](int r, int) { return r < 16 ? 1.0 : 0.0; });
  const std::string png = png_bytes(64, 32, 8, [](int, int) { return 200; });
  const std::string kinds = "; expected a picture in Radiance HDR, OpenEXR or PNG";
  CHECK(picture(hdr) == "");
  CHECK(picture(png) == "");
  CHECK(picture("") == "sky.hdr: found an empty file" + kinds);
  CHECK(picture("GIF89a") == "sky.hdr: found a file of another kind" + kinds);
  for (const auto& whole : {hdr, png})
    for (std::size_t n = 12; n + 1 < whole.size(); n += 1 + whole.size() / 97) {
      if (n + 12 > whole.size() && whole == png) break;  // the end mark of a PNG carries nothing
      CAPTURE(n);
      CHECK(picture(whole.substr(0, n)).find("sky.hdr: found a broken picture (") == 0);
    }
  CHECK(picture(std::string("\x76\x2f\x31\x01\x02\x00\x00\x00 no channels", 22)).find("sky.hdr: found a broken EXR (") == 0);
  CHECK(picture(hdr_bytes(32, 32, [](int, int) { return 1.0; })) ==
        "sky.hdr: found 32 x 32 pixels; expected a picture of all directions (equirectangular), twice as wide as high, 4 to 8192 columns");
  CHECK(picture("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000000 +X 2000000000\n").find("sky.hdr: found ") == 0);
  CHECK(picture("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 32768\n").find("sky.hdr: found 32768 x 16384 pixels") == 0);
  CHECK(picture(hdr_bytes(64, 32, [](int r, int) { return r < 16 ? 0.0 : 1.0; })) ==
        "sky.hdr: found a picture that is dark above the horizon; expected some light there");
  CHECK(picture(hdr, "turn = 400\n") == "scene.toml:6: sky.turn: found 400; expected a number from -360 to 360 degrees");
  CHECK(picture(hdr, "sun = \"away\"\n").find("scene.toml:6: sky.sun: found \"away\"; expected one of keep, cut") == 0);
  CHECK(picture(hdr, "sun = \"keep\"\n", "[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:9: sky.sun: found \"keep\" beside [sun]; expected \"cut\", or no [sun]: there is one sun");
  CHECK(picture(hdr, "directions = []\n") ==
        "scene.toml:6: sky.directions: found `directions` beside model = \"image\"; expected model = \"file\"");
  CHECK(message("[sky]\nmodel = \"image\"\nirradiance = { PAR = 1 }\n") ==
        "scene.toml:2: sky.file: found nothing; expected a picture of the sky");
  CHECK(
      message("[sky]\nmodel = \"image\"\nfile = \"none.exr\"\nirradiance = { PAR = 1 }\n").find("scene.toml:4: sky.file: found no file ") ==
      0);
}

TEST_CASE("Slopes that have no cell are refused", "[hostile][scene][slope]") {
  const std::string sky = "[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1 }\n", cell = "[domain]\nperiodic = [0, 0, 1, 1]\n";
  CHECK(message(cell + "slope = [0, inf]\n" + sky).find("scene.toml:4: domain.slope") == 0);
  CHECK(message(cell + "slope = [0, nan]\n" + sky).find("scene.toml:4: domain.slope") == 0);
  CHECK(message(cell + "slope = [0, 1e9]\n" + sky) ==
        "scene.toml:4: domain.slope: found [0, 1000000000], a slope of 90.00 degrees; expected dz/dx and dz/dy of a slope of at most 10 "
        "(84.29 "
        "degrees): an upright plane has no cell");
  CHECK(message(cell + "slope = 0.5\n" + sky).find("scene.toml:4: domain.slope: found 0.5; expected") == 0);
  CHECK(message("[domain]\nslope = [0, 1]\n" + sky).find("scene.toml:2: domain.periodic: found nothing") == 0);
}
