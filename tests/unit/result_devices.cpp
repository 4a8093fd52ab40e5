// Lamps and sensors in a result file: written, read again, exported.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/result_reader.hpp>
#include <sunfleck/view/export.hpp>

#include "places.hpp"
#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// The small scene with a lamp of two copies that shines at noon, a grid, a mesh with two sides and a profile.
struct Stored {
  Stored() : scene(small_scene()) {
    LampEntry lamp;
    lamp.name = "panel";
    lamp.mesh = Mesh{{{0, 0, 3}, {0, 1, 3}, {1, 1, 3}}, {{0, 1, 2}}};
    lamp.strength = {100, 20};
    lamp.placements = {{}, {Affine::translate({2, 0, 0})}};
    lamp.states = {0};
    scene.lamps.push_back(lamp);
    scene.sensors.push_back({"grid, low", SensorGrid{0.5, {3, 2}, {{1.5, 1.0}}, {{1.0, 2.0}}}, false, 0});
    scene.sensors.push_back({"mesh", Mesh{{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}, {{0, 1, 2}}}, true, 0});
    scene.sensors.push_back({"layers", SensorProfile{0.25, 0.0, 0.5, {{1.0, 1.0}}, {{0.0, 0.0}}}, true, 0});
    const FacetScene facets = expand(scene);
    const PlacedScene copies = place(scene);
    ResultWriter writer(folder / "r.h5", scene, copies, OutputChoice{}, "0.1.0", "flat");
    Values(facets).send(writer, 1000);
    auto report = small_report();
    float next = 1;
    for (auto& sensor : place_sensors(scene, facets.bounds)) {
      auto& reading = report.sensors.emplace_back();
      reading.cells = sensor.cells;
      const auto fill = [&](std::vector<float>& values) {
        for (std::size_t i = 0; i < 2 * 2 * reading.cells.size(); ++i) values.push_back(next += 0.125f);
      };
      fill(reading.irradiance), fill(reading.standard_error);
      if (sensor.entry->both_sides) fill(reading.back), fill(reading.back_standard_error);
    }
    readings = report.sensors;
    writer.finish(report);
  }
  Folder folder;
  Scene scene;
  std::vector<SensorReading> readings;
};

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("Lamps and sensors are read as they were written", "[result][lamps][sensors]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  const auto lamps = result.lamps();
  REQUIRE(lamps.size() == 1);
  CHECK(lamps[0].name == "panel");
  CHECK(lamps[0].copies == 2);
  CHECK(lamps[0].power == std::vector<double>{100, 20});  // two faces of half a square metre
  CHECK(lamps[0].shines == std::vector<bool>{true, false});
  const auto sensors = result.sensors();
  REQUIRE(sensors.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    INFO(sensors[i].name);
    CHECK(sensors[i].name == stored.scene.sensors[i].name);
    CHECK(sensors[i].kind == kind_of(stored.scene.sensors[i]));
    const auto& wanted = stored.readings[i];
    REQUIRE(sensors[i].size() == wanted.cells.size());
    CHECK(sensors[i].reading.irradiance == wanted.irradiance);
    CHECK(sensors[i].reading.standard_error == wanted.standard_error);
    CHECK(sensors[i].reading.back == wanted.back);
    CHECK(sensors[i].reading.back_standard_error == wanted.back_standard_error);
    for (std::size_t k = 0; k < wanted.cells.size(); ++k) {
      const Vec3 c = wanted.cells[k].centroid(), n = wanted.cells[k].normal();
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(sensors[i].centroid[3 * k + static_cast<std::size_t>(axis)] == c[axis]);
        CHECK(sensors[i].normal[3 * k + static_cast<std::size_t>(axis)] == n[axis]);
      }
      CHECK(sensors[i].area[k] == static_cast<float>(wanted.cells[k].area()));
    }
  }
  CHECK(sensors[0].cells == std::vector<std::uint32_t>{3, 2});
  CHECK(sensors[1].cells.empty());
  CHECK(sensors[2].size() == 3);  // 0, .25, .5 m
}

TEST_CASE("A scene without lamps and sensors leaves no trace of them in the file", "[result][lamps][sensors]") {
  Folder folder;
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const PlacedScene copies = place(scene);
  ResultWriter writer(folder / "r.h5", scene, copies, OutputChoice{}, "0.1.0", "flat");
  Values(facets).send(writer, 1000);
  writer.finish(small_report());
  const Result result(folder / "r.h5");
  for (const char* name : {"lamps", "sensors", "names/sensor"}) CHECK_FALSE(result.has(name));
  CHECK(result.lamps().empty());
  CHECK(result.sensors().empty());
  CHECK_THROWS_WITH(export_sensors(result, folder / "s.csv", {}, silent()),
                    result.file() + ": found no sensor; expected a result of a scene with [[sensor]]");
  CHECK(folder.files() == 1);
}

TEST_CASE("Sensors as a table: a row a cell, every value, backs where there are some", "[view][export][sensors]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  const std::string file = stored.folder / "s.csv";
  CHECK(export_sensors(result, file, {"grid, low"}, silent()) == 6);
  std::istringstream grid(text_of(file));
  std::string line;
  std::getline(grid, line);
  CHECK(line ==
        "sensor,kind,cell,x,y,z,normal_x,normal_y,normal_z,area_m2,irradiance_PAR_noon,standard_error_PAR_noon,irradiance_NIR_noon,"
        "standard_error_NIR_noon,irradiance_PAR_evening,standard_error_PAR_evening,irradiance_NIR_evening,standard_error_NIR_evening,"
        "exposure_J_m2_PAR,exposure_J_m2_NIR");
  std::getline(grid, line);
  // cell 0 at the lowest x and y; 24 values of irradiance from 1.125 on (state, cell, band), then as many errors; 3600 s and 1800 s
  CHECK(line == "\"grid, low\",grid,0,0.5,1.75,0.5,0,0,1,0.25,1.125,4.125,1.25,4.25,2.625,5.625,2.75,5.75,8775,9450");

  CHECK(export_sensors(result, file, {}, silent()) == 6 + 1 + 3);
  std::istringstream all(text_of(file));
  std::getline(all, line);
  const auto fields = [](const std::string& row) { return std::count(row.begin(), row.end(), ','); };
  const auto columns = fields(line);
  CHECK(line.find(",irradiance_back_PAR_noon,standard_error_back_PAR_noon,") != std::string::npos);
  std::getline(all, line);
  CHECK(fields(line) == columns + 1);                                    // one within quotes
  CHECK(line.find(",1.125,4.125,,,1.25,4.25,,,") != std::string::npos);  // no back
  CHECK_THROWS_WITH(export_sensors(result, file, {"layer"}, silent()),
                    "--sensor: found 'layer'; expected all, or some of grid, low, mesh, layers (did you mean 'layers'?)");
}

TEST_CASE("h5py reads sensors by the names of the documentation", "[result][sensors][readers]") {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) {
    WARN("skipped: /usr/bin/python3 with h5py is not there");
    return;
  }
  const Stored stored;
  std::ofstream(stored.folder / "read.py") << R"(
import h5py, sys
with h5py.File(sys.argv[1]) as f:
    assert list(f["names/sensor"].asstr()) == ["grid, low", "mesh", "layers"]
    grid = f["sensors/grid, low"]
    assert grid.attrs["kind"] in ("grid", b"grid")
    assert grid["irradiance"].shape == (2, 6, 2)
    assert list(grid["cells"][:]) == [3, 2]
    assert grid["irradiance"][0, :, 0].reshape(2, 3)[0, 1] == 1.125 + 0.25
    assert f["sensors/layers/irradiance_back"].shape == (2, 3, 2)
    assert list(f["sensors/layers/height"][:]) == [0.0, 0.25, 0.5]
    assert f["lamps/power"][0, 0] == 100.0 and f["lamps/copies"][0] == 2
)";
  const Result result(stored.folder / "r.h5");
  export_sensors(result, stored.folder / "sensors.csv", {}, silent());
  CHECK(std::system((std::string("/usr/bin/python3 ") + SUNFLECK_SOURCE_DIR + "/tests/readers/check_export.py " + (stored.folder / "r.h5") +
                     " " + (stored.folder / "sensors.csv") + " >&2")
                        .c_str()) == 0);
  CHECK(std::system(("/usr/bin/python3 " + (stored.folder / "read.py") + " " + (stored.folder / "r.h5")).c_str()) == 0);
}
