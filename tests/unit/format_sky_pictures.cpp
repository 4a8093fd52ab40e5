// Skies of scene files that are pictures or weather.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <picture_files.hpp>
#include <scene_files.hpp>
#include <sunfleck/light/sun.hpp>
#include <sunfleck/scene/content.hpp>

using namespace sunfleck;

namespace {

using std::numbers::pi;

std::string scene(const std::string& sky, const std::string& before = "") {
  return "bands = [\"PAR\"]\n" + before + "[sky]\nirradiance = { PAR = 100 }\n" + sky;
}

std::string picture(const std::string& file, const std::string& more = "") {
  return "model = \"image\"\nfile = \"" + file + "\"\n" + more;
}

/// A lobe about the zenith, dark below the horizon, of values that HDR holds exactly.
double lobe(int row, int rows) {
  return std::max(0.0, std::floor(255 * std::cos(pi * (row + 0.5) / rows))) / 256;
}

std::string exr_bytes(int columns, int rows, const std::function<float(int, int)>& value, const std::vector<const char*>& channels) {
  const std::string path = (std::filesystem::temp_directory_path() / ("sunfleck_test_" + std::to_string(std::rand()) + ".exr")).string();
  std::vector<float> data;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) data.push_back(value(row, column));
  {
    Imf::Header header(columns, rows);
    Imf::FrameBuffer buffer;
    for (const char* name : channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(data.data()), sizeof(float),
                                     sizeof(float) * static_cast<std::size_t>(columns)));
    }
    Imf::OutputFile out(path.c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(rows);
  }
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(path);
  return bytes;
}

Sky sky_of(const std::string& name, const std::string& bytes, const std::string& more = "") {
  return *SceneFiles(scene(picture(name, more)), {{name, bytes}}).read().states[0].sky;
}

const int sun_row = 60, sun_column = 200;
std::string sunny_hdr() {
  return hdr_bytes(512, 256, [](int row, int column) { return row == sun_row && column == sun_column ? 65536.0 : row < 128 ? 1.0 : 0.25; });
}

}  // namespace

TEST_CASE("A sky is the same from HDR, EXR and PNG", "[format][sky]") {
  const auto grey = [](int row, int) { return lobe(row, 64); };
  const Sky hdr = sky_of("a.hdr", hdr_bytes(128, 64, grey));
  const Sky rgb = sky_of("a.exr", exr_bytes(128, 64, [](int r, int) { return static_cast<float>(lobe(r, 64)); }, {"R", "G", "B", "A"}));
  const Sky y = sky_of("a.exr", exr_bytes(128, 64, [](int r, int) { return static_cast<float>(lobe(r, 64)); }, {"Y"}));
  const Sky deep = sky_of("a.png", png_bytes(128, 64, 16, [](int r, int) { return static_cast<int>(lobe(r, 64) * 65535); }));
  const Sky coded =
      sky_of("a.png", png_bytes(128, 64, 8, [](int r, int) {
               const double v = lobe(r, 64);
               return static_cast<int>(std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
             }));
  const Sky plain = sky_of("a.png", png_bytes(128, 64, 8, [](int r, int) { return static_cast<int>(std::lround(255 * lobe(r, 64))); }),
                           "encoding = \"linear\"\n");
  CHECK(hdr.irradiance == std::vector<double>{100});
  for (const double zenith : {1.0, 20.0, 40.0, 60.0, 80.0}) {
    const Vec3 d = direction_from_angles(90 - zenith, 33);
    const double expected = hdr.relative_radiance(d);
    CHECK(expected == Approx(std::cos(zenith * pi / 180) * 3 / (2 * pi)).epsilon(0.06));  // 2.8 degrees a pixel, 255 steps
    CHECK(rgb.relative_radiance(d) == Approx(expected).epsilon(1e-6));
    CHECK(y.relative_radiance(d) == Approx(expected).epsilon(1e-6));
    CHECK(deep.relative_radiance(d) == Approx(expected).epsilon(1e-3));
    CHECK(coded.relative_radiance(d) == Approx(expected).epsilon(0.03));  // 255 steps of the code
    CHECK(plain.relative_radiance(d) == Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("A picture's sun is followed as a sun, turned with it, or cut out", "[format][sky]") {
  const std::string bytes = sunny_hdr();
  const auto read = [&](const std::string& more, const std::string& before = "") {
    return SceneFiles(scene(picture("s.hdr", more), before), {{"s.hdr", bytes}}).read();
  };
  const double row_angle = pi / 256;
  const Vec3 towards = direction_from_angles(90 - 180 * (sun_row + 0.5) / 256, 360 * ((sun_column + 0.5) / 512 - 0.5) + 40);
  const double pixel = pi / 512 * (std::pow(std::sin(row_angle * (sun_row + 1)), 2) - std::pow(std::sin(row_angle * sun_row), 2));
  const double share = 65535 * pixel / (65535 * pixel + pi);
  const Scene kept = read("turn = 40\n");
  REQUIRE(kept.states[0].sun);
  CHECK(glm::length(kept.states[0].sun->direction - towards) < 1e-9);
  CHECK(kept.states[0].sun->irradiance[0] * towards.z == Approx(100 * share).epsilon(1e-6));
  CHECK(kept.states[0].sky->irradiance[0] == Approx(100 * (1 - share)).epsilon(1e-6));
  CHECK(kept.states[0].sky->relative_radiance(towards) == Approx(1 / pi).epsilon(1e-6));
  REQUIRE(kept.notes.size() == 1);
  CHECK(kept.notes[0].find("the picture's sun, at elevation 47.46 degrees with ") != std::string::npos);
  const Scene cut = read("turn = 40\nsun = \"cut\"\n");
  CHECK_FALSE(cut.states[0].sun);
  CHECK(cut.states[0].sky->irradiance[0] == 100);
  CHECK(cut.states[0].sky->relative_radiance(towards) == Approx(1 / pi).epsilon(1e-6));
  const Scene own = read("", "[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = 3 }\n");
  CHECK(own.states[0].sun->irradiance[0] == 3);
  CHECK(own.states[0].sky->irradiance[0] == 100);
  const Scene alone =
      SceneFiles(scene(picture("s.hdr")), {{"s.hdr", hdr_bytes(128, 64, [](int r, int c) { return r == 20 && c == 3 ? 1.0 : 0.0; })}})
          .read();
  CHECK_FALSE(alone.states[0].sky);
  CHECK(alone.states[0].sun->irradiance[0] * alone.states[0].sun->direction.z == Approx(100));
}

TEST_CASE("Scenes differ by their picture, its turn and the weather", "[format][sky]") {
  const auto key = [](const Scene& s) { return scene_key(s, geometry_key(s)); };
  const std::string a = hdr_bytes(16, 8, [](int r, int) { return r < 3 ? 1.0 : 0.5; }),
                    b = hdr_bytes(16, 8, [](int r, int) { return r < 2 ? 1.0 : 0.5; });
  const auto of = [&](const std::string& bytes, const std::string& more) {
    return key(SceneFiles(scene(picture("s.hdr", more)), {{"s.hdr", bytes}}).read());
  };
  CHECK(of(a, "") == of(a, "turn = 0\n"));
  CHECK(of(a, "") != of(b, ""));
  CHECK(of(a, "") != of(a, "turn = 10\n"));
  const auto perez = [&](const std::string& weather) {
    return key(SceneFiles(scene("model = \"perez\"\n" + weather, "[sun]\nelevation = 40\nazimuth = 0\nirradiance = { PAR = 0 }\n")).read());
  };
  CHECK(perez("clearness = 2\nbrightness = 0.2\n") != perez("clearness = 3\nbrightness = 0.2\n"));
  CHECK(perez("clearness = 2\nbrightness = 0.2\n") != perez("clearness = 2\nbrightness = 0.3\n"));
}

TEST_CASE("The weather of a Perez sky comes from numbers, from irradiances, from global radiation or from the bands", "[format][sky]") {
  const std::string sun = "[sun]\nelevation = 30\nazimuth = 0\nirradiance = { PAR = 600 }\n";
  const auto read = [](const std::string& text) { return SceneFiles(text).read(); };
  const auto given = read(scene("model = \"perez\"\nclearness = 2.5\nbrightness = 0.3\n", sun)).states[0].sky;
  CHECK(given->weather->clearness == 2.5);
  CHECK(given->weather->brightness == 0.3);
  CHECK(given->normalisation > 0);
  const PerezWeather expected = perez_weather(600, 100, 30, 0, "");
  const auto same = [&](const Scene& s, const PerezWeather& w) {
    CHECK(s.states[0].sky->weather->clearness == Approx(w.clearness));
    CHECK(s.states[0].sky->weather->brightness == Approx(w.brightness));
  };
  same(read(scene("model = \"perez\"\ndirect = 600\ndiffuse = 100\n", sun)), expected);
  same(read(scene("model = \"perez\"\ndirect = 600\ndiffuse = 100\nday = 3\n", sun)), perez_weather(600, 100, 30, 3, ""));
  const Scene bands = read(scene("model = \"perez\"\n", sun));
  same(bands, expected);
  REQUIRE(bands.notes.size() == 1);
  CHECK(bands.notes[0].find("no `direct` and `diffuse`: the bands' sums, 600 and 100 W m^-2") != std::string::npos);
  const Scene split = read(
      "bands = [\"PAR\"]\n[sun]\nelevation = 30\nazimuth = 0\n[sky]\nmodel = \"perez\"\n[global]\nshortwave = 400\nday = 172\nirradiance = "
      "{ PAR = 180 }\n");
  const double beam = split.states[0].sun->irradiance[0] * 400 / 180, diffuse = split.states[0].sky->irradiance[0] * 400 / 180;
  same(split, perez_weather(beam, diffuse, 30, 172, ""));
  CHECK_FALSE(read("bands = [\"PAR\"]\n[sun]\nelevation = -3\nazimuth = 0\nirradiance = { PAR = 0 }\n[sky]\nmodel = \"perez\"\nirradiance "
                   "= { PAR = 0 }\n")
                  .states[0]
                  .sky);
}
