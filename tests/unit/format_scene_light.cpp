// Bands, sun, sky, states and global radiation as scene files give them.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <picture_files.hpp>
#include <scene_files.hpp>
#include <sunfleck/light/split.hpp>

using namespace sunfleck;

namespace {

constexpr double degree = std::numbers::pi / 180;

Scene read(const std::string& text) {
  return SceneFiles(text).read();
}

SceneFile read_file(const std::string& text) {
  return SceneFiles(text).read_file();
}

const std::string band = "bands = [\"PAR\"]\n";
const std::string sky = "[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 50 }\n";

/// 1e-12: roundings of unit vectors.
bool near(const Vec3& a, const Vec3& b) {
  return glm::length(a - b) < 1e-12;
}

Vec3 sun_at(const std::string& keys) {
  return read(band + "[sun]\n" + keys + "irradiance = { PAR = 1 }\n").states[0].sun->direction;
}

}  // namespace

TEST_CASE("Units are per band, W m^-2 unless the scene says otherwise", "[format][scene]") {
  const Scene scene = read(
      "bands = [\"PAR\", \"NIR\", \"red\"]\nunits = { PAR = \"umol m-2 s-1\", red = \"W m-2\" }\n"
      "[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1500, NIR = 400.5, red = 0 }\n");
  CHECK(scene.band_units == std::vector<std::string>{"umol m^-2 s^-1", "W m^-2", "W m^-2"});
  CHECK(scene.states[0].sky->irradiance == std::vector<double>{1500, 400.5, 0});
}

TEST_CASE("The sun stands where direction, angles, or time and place put it", "[format][scene]") {
  CHECK(near(sun_at("direction = [0.5, 0.0, 0.8]\n"), glm::normalize(Vec3{0.5, 0, 0.8})));
  CHECK(near(sun_at("direction = [0, 3e200, 4e200]\n"), Vec3{0, 0.6, 0.8}));
  CHECK(near(sun_at("elevation = 30\nazimuth = 90\n"), Vec3{std::cos(30 * degree), 0, 0.5}));  // east
  CHECK(near(sun_at("elevation = 90\nazimuth = 0\n"), Vec3{0, 0, 1}));
  const Vec3 as_text = sun_at("latitude = 43.6\nlongitude = 3.9\ntime = \"2026-06-21T09:00:00+02:00\"\n");
  const Vec3 as_date = sun_at("latitude = 43.6\nlongitude = 3.9\naltitude = 0\ntime = 2026-06-21T07:00:00Z\n");
  CHECK(near(as_text, as_date));
  const auto position = solar_position("2026-06-21T07:00:00Z", 43.6, 3.9, 0, "test");
  CHECK(near(as_text, direction_from_angles(position.elevation_deg, position.azimuth_deg)));
}

TEST_CASE("The sun's disc is 0.53 degrees wide unless the scene says otherwise", "[format][scene]") {
  CHECK(read(band + "[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 1 }\n").states[0].sun->angular_diameter_deg == 0.53);
  CHECK(read(band + "[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 1 }\nangular_diameter = 0\n").states[0].sun->angular_diameter_deg ==
        0.0);
}

TEST_CASE("A sun below the horizon is no sun, with a note", "[format][scene]") {
  const SceneFiles files(band + "[sun]\nelevation = -3.5\nazimuth = 10\nirradiance = { PAR = 1 }\n" + sky);
  const Scene scene = files.read();
  CHECK_FALSE(scene.states[0].sun);
  REQUIRE(scene.states[0].sky);
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0] == files.file().path + ":2: sun: the sun is 3.50 degrees below the horizon: no sun");
  // A clear sky is built about the sun; where it gives no light it may lack one.
  const Scene night =
      read(band + "[sun]\nelevation = -3.5\nazimuth = 10\nirradiance = { PAR = 0 }\n[sky]\nmodel = \"clear\"\nirradiance = { PAR = 0 }\n");
  CHECK_FALSE(night.states[0].sky);
}

TEST_CASE("All sky models of this version can be named", "[format][scene]") {
  for (const std::string& name : sky_model_names()) {
    const SceneFiles files(band + "[sun]\ndirection = [0, 1, 1]\nirradiance = { PAR = 1 }\n[sky]\nmodel = \"" + name +
                               "\"\nirradiance = { PAR = 50 }\n" +
                               (name == "file"    ? "directions = [[0, 0, 1, 2.0], [1, 0, 0.1, 1.0]]\n"
                                : name == "image" ? "file = \"sky.hdr\"\n"
                                                  : ""),
                           {{"sky.hdr", hdr_bytes(8, 4, [](int, int) { return 1.0; })}});
    const Scene scene = files.read();
    CHECK(name_of(scene.states[0].sky->model) == name);
  }
  const Scene clear =
      read(band + "[sun]\ndirection = [0, 1, 1]\nirradiance = { PAR = 1 }\n[sky]\nmodel = \"clear\"\nirradiance = { PAR = 50 }\n");
  CHECK(near(*clear.states[0].sky->sun, glm::normalize(Vec3{0, 1, 1})));
  CHECK(clear.states[0].sky->normalisation > 0);  // prepared
}

TEST_CASE("States keep their order, names and durations", "[format][scene]") {
  const Scene scene =
      read(band +
           "[[state]]\nname = \"dawn\"\nduration_s = 1800\nsun = { elevation = -1, azimuth = 60, irradiance = { PAR = 5 } }\n"
           "[[state]]\nsun = { elevation = 50, azimuth = 180, irradiance = { PAR = 300 } }\n"
           "sky = { model = \"standard_overcast\", irradiance = { PAR = 90 } }\n");
  REQUIRE(scene.states.size() == 2);
  CHECK(scene.states[0].name == "dawn");
  CHECK(scene.states[0].duration_s == 1800);
  CHECK_FALSE(scene.states[0].sun);
  CHECK(scene.notes.size() == 1);
  CHECK(scene.states[1].name == "state 2");
  CHECK(scene.states[1].duration_s == 0);
  CHECK(scene.states[1].sun->irradiance == std::vector<double>{300});
  CHECK(scene.states[1].sky->model == SkyModel::standard_overcast);
}

TEST_CASE("Global radiation is split between sun and sky", "[format][scene]") {
  const std::string text =
      "bands = [\"PAR\", \"NIR\"]\n[sun]\nelevation = 50\nazimuth = 180\n[sky]\nmodel = \"uniform\"\n[global]\nday = 172\nshortwave = "
      "700\nirradiance = { PAR = 300, NIR = 350 }\n";
  const Scene scene = read(text);
  const GlobalSplit shares = split_global(700, 50, 172);
  REQUIRE(shares.direct > 0.3);
  for (const std::size_t b : {0, 1}) {
    const double global = b == 0 ? 300 : 350, beam = scene.states[0].sun->irradiance[b] * std::sin(50 * degree),
                 diffuse = scene.states[0].sky->irradiance[b];
    CHECK(diffuse == Approx(shares.diffuse * global).epsilon(1e-12));
    CHECK(beam + diffuse == Approx(global).epsilon(1e-12));
  }
  CHECK(scene.notes.empty());

  // Without `shortwave` the sum of the bands stands in for it, with a note; the date may come from the sun's own time.
  const Scene dated = read(
      "bands = [\"PAR\", \"NIR\"]\n[[state]]\nname = \"noon\"\nsun = { latitude = 43, longitude = 3, time = 2026-06-21T12:00:00Z }\n"
      "sky = { model = \"uniform\" }\nglobal = { irradiance = { PAR = 300, NIR = 350 } }\n");
  REQUIRE(dated.notes.size() == 1);
  CHECK(dated.notes[0].find("state[0].global: no `shortwave`: the bands' sum, 650 W m^-2, is taken") != std::string::npos);
  const double elevation = std::asin(dated.states[0].sun->direction.z) / degree;
  CHECK(dated.states[0].sky->irradiance[0] == Approx(300 * split_global(650, elevation, 172).diffuse).epsilon(1e-9));

  // Below the horizon all of it is sky.
  const Scene dusk = read(
      "bands = [\"PAR\"]\n[sun]\nelevation = -1\nazimuth = 300\n[sky]\nmodel = \"uniform\"\n[global]\nday = 172\nshortwave = 8\nirradiance "
      "= { PAR = 4 }\n");
  CHECK_FALSE(dusk.states[0].sun);
  CHECK(dusk.states[0].sky->irradiance == std::vector<double>{4});
}

TEST_CASE("[output] and [solve] are kept as chosen", "[format][scene]") {
  const SceneFile plain = read_file(band + sky);
  CHECK(plain.output.facets);
  CHECK(plain.output.fields.empty());
  CHECK_FALSE(plain.run.quality);
  const SceneFile chosen = read_file(band + sky +
                                     "[output]\nfacets = false\nfields = [\"organs/absorbed\", \"organs/sunlit\"]\n"
                                     "[solve]\nquality = \"fine\"\nmethod = \"reference\"\nseed = 7\ncertificate = false\nsamples = 256\n");
  CHECK_FALSE(chosen.output.facets);
  CHECK(chosen.output.fields == std::vector<std::string>{"organs/absorbed", "organs/sunlit"});
  CHECK(chosen.run.quality == Quality::fine);
  CHECK(chosen.run.method == "reference");
  CHECK(chosen.run.seed == 7u);
  CHECK(chosen.run.certificate == false);
  CHECK(chosen.run.samples == 256u);
}
