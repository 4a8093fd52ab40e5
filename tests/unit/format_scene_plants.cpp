// Optics, ground, plants, placements and groups as scene files give them.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include <scene_files.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/facets.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

const std::string head = R"(bands = ["PAR"]
[sky]
model = "uniform"
irradiance = { PAR = 50 }
[optics.dark]
reflectance = { PAR = 0.1 }
[optics.light]
reflectance_front = { PAR = 0.5 }
reflectance_back = { PAR = 0.6 }
transmittance = { PAR = 0.2 }
)";

/// One plant "p" of two organs, whose type is organ, with materials m and n; then `rest`.
std::string with_plant(const std::string& optics, const std::string& rest = {}) {
  return head + "[[plant]]\nname = \"p\"\nfile = \"two.obj\"\noptics = " + optics + "\n" + rest;
}

Scene read(const std::string& text, std::map<std::string, std::string> files = {}) {
  files["two.obj"] = two_organs;
  return SceneFiles(text, files).read();
}

std::vector<std::uint32_t> rows(const std::string& optics) {
  return read(with_plant(optics)).plants[0].shape_optics;
}

bool near(const Vec3& a, const Vec3& b) {
  return glm::length(a - b) < 1e-12;
}

}  // namespace

TEST_CASE("Optics have sides, and no transmittance unless given", "[format][scene]") {
  const Scene scene = read(head);
  REQUIRE(scene.optics.size() == 2);
  CHECK(scene.optics[0].name == "dark");
  CHECK(scene.optics[0].transmittance == std::vector<float>{0.0f});
  CHECK(scene.optics[1].reflectance_front == std::vector<float>{0.5f});
  CHECK(scene.optics[1].reflectance_back == std::vector<float>{0.6f});
  // rho + tau = 1 is allowed, also where single precision rounds it up.
  CHECK_NOTHROW(
      read("bands = [\"PAR\"]\nsky = { model = \"uniform\", irradiance = { PAR = 1 } }\n[optics.a]\nreflectance = { PAR = 0.55 "
           "}\ntransmittance = { PAR = 0.45 }\n"));
}

TEST_CASE("Optics are found by structure name, then type, then material, then the star", "[format][scene]") {
  using Rows = std::vector<std::uint32_t>;  // 0 dark, 1 light
  CHECK(rows(R"({ "*" = "light" })") == Rows{1, 1});
  CHECK(rows(R"({ m = "dark", n = "light" })") == Rows{0, 1});
  CHECK(rows(R"({ m = "dark", "*" = "light" })") == Rows{0, 1});
  CHECK(rows(R"({ organ = "light", m = "dark" })") == Rows{1, 1});
  CHECK(rows(R"({ a = "dark", organ = "light", m = "light" })") == Rows{0, 1});
}

TEST_CASE("Optics keys that name nothing are refused where they look misspelt, else noted", "[format][scene]") {
  const SceneFiles misspelt(with_plant(R"({ orgam = "dark", "*" = "light" })"), {{"two.obj", two_organs}});
  CHECK(misspelt.message() ==
        "scene.toml:14: plant[0].optics.orgam: found a key that is no structure name, type or material of two.obj; expected one that is; "
        "did you mean "
        "\"organ\"?");
  const Scene scene = read(with_plant(R"({ Rhizome = "dark", "*" = "light" })", "place = [ { position = [0, 0, 0] } ]\n"));
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0].find("plant[0].optics.Rhizome: a key that is no structure name, type or material of ") != std::string::npos);
}

TEST_CASE("A file that two plants name is read once per unit", "[format][scene]") {
  const Scene scene = read(
      with_plant(
          R"({ "*" = "dark" })",
          "[[plant]]\nname = \"q\"\nfile = \"./folder/../two.obj\"\noptics = { \"*\" = \"light\" }\n"
          "[[plant]]\nname = \"r\"\nfile = \"two.obj\"\nunit = \"cm\"\noptics = { \"*\" = \"light\" }\nplace = { position = [0, 0, 0] }\n"),
      {{"folder/x", ""}});
  CHECK(scene.plants[0].plant == scene.plants[1].plant);
  CHECK(scene.plants[0].plant != scene.plants[2].plant);
  CHECK(scene.plants[2].plant->area() == Approx(2e-4));
  CHECK(scene.plants[1].shape_optics == std::vector<std::uint32_t>{1, 1});
  CHECK(scene.notes.size() == 2);  // p and q stand nowhere
}

TEST_CASE("Units multiply lengths", "[format][scene]") {
  for (const auto& [unit, metres] :
       std::map<std::string, double>{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}}) {
    const Scene scene = read(with_plant(R"({ "*" = "dark" })", "unit = \"" + unit + "\"\nplace = { position = [0, 0, 0] }\n"));
    CHECK(expand(scene).bounds.high.x == Approx(metres).epsilon(1e-14));
  }
}

TEST_CASE("Single places, grids and files place copies", "[format][scene]") {
  const Scene scene = read(
      with_plant(
          R"({ "*" = "dark" })",
          "place = [ { position = [1, 2, 3], turn = 90, scale = 2 }, { grid = { origin = [10, 20], step = [1, 2], count = [2, 3] } },\n"
          "  { file = \"spots.csv\" }, { file = \"plain.csv\" } ]\n"),
      {{"spots.csv", "x, y, scale, mirror\n# a comment\n5, 6, 0.5, 1\n\n7, 8, 1, 0 # the last\n"}, {"plain.csv", "1,2,3,180\r\n"}});
  const auto& all = scene.plants[0].placements;
  REQUIRE(all.size() == 1 + 6 + 2 + 1);
  CHECK(near(all[0].map.point({1, 0, 0}), Vec3{1, 4, 3}));
  CHECK(near(all[1].map.translation, Vec3{10, 20, 0}));
  CHECK(near(all[2].map.translation, Vec3{11, 20, 0}));  // along x first
  CHECK(near(all[3].map.translation, Vec3{10, 22, 0}));
  CHECK(near(all[6].map.translation, Vec3{11, 24, 0}));
  CHECK(near(all[7].map.point({2, 0, 0}), Vec3{4, 6, 0}));  // mirrored and half as large
  CHECK(near(all[8].map.point({2, 0, 0}), Vec3{9, 8, 0}));
  CHECK(near(all[9].map.point({1, 0, 0}), Vec3{0, 2, 3}));
}

TEST_CASE("Random turns come from the seed and the cell alone", "[format][scene]") {
  const auto grid = [](const std::string& keys) {
    return read(with_plant(R"({ "*" = "dark" })", "grid = { step = [1, 1], turn = \"random\", " + keys + " }\n")).plants[0].placements;
  };
  const auto small = grid("count = [3, 3], seed = 4"), large = grid("count = [3, 30], seed = 4"), other = grid("count = [3, 3], seed = 5");
  std::set<double> turns;
  for (std::size_t i = 0; i < 9; ++i) {
    CHECK(small[i].map.linear == large[i].map.linear);
    CHECK(small[i].map.linear != other[i].map.linear);
    turns.insert(small[i].map.linear[0][0]);
  }
  CHECK(turns.size() == 9);
}

TEST_CASE("Groups hold plants and groups, also ones that come later", "[format][scene]") {
  const Scene scene = read(with_plant(R"({ "*" = "dark" })", R"(
[[group]]
name = "stand"
place = [ { group = "tile", grid = { step = [10, 10], count = [2, 1] } }, { plant = "p", position = [100, 0, 0] } ]
[[group]]
name = "tile"
place = [ { plant = "p", position = [1, 0, 0], turn = 90 }, { plant = "p", position = [2, 0, 0] } ]
[[place]]
group = "stand"
position = [1000, 0, 0]
[[place]]
plant = "p"
position = [0, 0, 5]
)"));
  CHECK(scene.notes.empty());
  REQUIRE(scene.groups.size() == 2);
  CHECK(scene.groups[0].members.size() == 3);
  CHECK(scene.groups[0].members[0].is_group);
  CHECK(scene.groups[0].members[1].index == 1);
  const FacetScene facets = expand(scene);
  CHECK(facets.organs.placements == std::vector<std::string>{"p[0]", "stand[0]/tile[0]/p[0]", "stand[0]/tile[0]/p[1]",
                                                             "stand[0]/tile[1]/p[0]", "stand[0]/tile[1]/p[1]", "stand[0]/p[0]"});
  const std::vector<double> x{0, 1001, 1002, 1011, 1012, 1100};
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(facets.copies[i].translation.x == Approx(x[i]));
}

TEST_CASE("What stands nowhere is noted", "[format][scene]") {
  const SceneFiles files(
      with_plant(R"({ "*" = "dark" })", "[[group]]\nname = \"tile\"\nplace = [ { plant = \"p\", position = [0, 0, 0] } ]\n"),
      {{"two.obj", two_organs}});
  const Scene scene = files.read();
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0] == files.file().path + ": group \"tile\" is placed nowhere: it has no part in the scene");
}

TEST_CASE("Ground fills a periodic cell without being told, and may be a mesh", "[format][scene]") {
  const Scene cell = read(head + "[domain]\nperiodic = [1, 2, 4, 4]\n[ground]\nreflectance = { PAR = 0.2 }\n");
  CHECK(cell.ground->size == std::array<double, 2>{3, 2});
  CHECK(cell.ground->centre == std::array<double, 2>{2.5, 3});
  CHECK(cell.ground->cells == std::array<std::uint32_t, 2>{10, 10});
  const Scene terrain = read(head + "[ground]\nmesh = \"two.obj\"\nunit = \"cm\"\nreflectance = { PAR = 0.2 }\n");
  REQUIRE(terrain.ground->mesh);
  CHECK(terrain.ground->mesh->triangles.size() == 4);
  CHECK(expand(terrain).bounds.high.x == Approx(0.01));
}

TEST_CASE("A species grows where a plant file could stand, once per age and seed", "[format][scene]") {
  const std::string species = std::string(SUNFLECK_SOURCE_DIR) + "/plants/maize.toml";
  const auto maize = [&](const std::string& name, const std::string& keys) {
    return "[[plant]]\nname = \"" + name + "\"\nfile = \"" + species +
           "\"\noptics = { \"*\" = \"dark\" }\nplace = { position = [0, 0, 0] }\n" + keys;
  };
  const Scene scene =
      read(head + maize("a", "age = 30\nseed = 1\n") + maize("b", "age = 30\nseed = 1\n") + maize("c", "age = 30\nseed = 2\n"));
  CHECK(scene.plants[0].plant == scene.plants[1].plant);
  CHECK(scene.plants[0].plant != scene.plants[2].plant);
  CHECK(scene.plants[0].plant->facet_count() > 100);
}

TEST_CASE("The shared benchmark scenes are read whole", "[format][scene][extra]") {
  const std::string coffee = extra_data("scenes/coffee.toml"), wheat = extra_data("scenes/wheat.toml");
  if (coffee.empty() || wheat.empty()) {
    WARN("skipped: SUNFLECK_EXTRA_DATA has no scenes/coffee.toml and scenes/wheat.toml");
    return;
  }
  const FacetScene facets = expand(read_scene(coffee));
  CHECK(facets.plant_facets == 118798);
  CHECK(facets.size() == 118798 + 3200);
  const Scene field = read_scene(wheat);
  CHECK(field.states.size() == 3);
  CHECK(field.states[2].name == "12:00");
  CHECK(expand(field).zero_area_facets < 100);
}
