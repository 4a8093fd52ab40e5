#include <catch2/catch.hpp>

#include <numbers>

#include <fmt/format.h>

#include <sunfleck/format/import_scene.hpp>

#include "scene_files.hpp"

using namespace sunfleck;

namespace {

constexpr double pi = std::numbers::pi;

/// Files of a case in a folder, imported and read as the scene they become.
class Case {
 public:
  explicit Case(const std::map<std::string, std::string>& files) : files_("# not yet\n", files) {}
  ImportChoice choice(const std::vector<std::string>& names) const {
    ImportChoice c;
    for (const auto& name : names) c.files.push_back(path(name));
    c.output = path("scene.toml");
    return c;
  }
  std::string path(const std::string& name) const { return files_.file().folder() + "/" + name; }
  Scene read(const ImportChoice& c) {
    const ImportedScene imported = import_scene(c);
    notes = imported.notes;
    std::ofstream(path("scene.toml")) << imported.text;
    return files_.read();
  }
  template <class Call>
  std::string message(Call&& call) const {
    return message_of(files_.file(), call);
  }
  std::vector<std::string> notes;

 private:
  SceneFiles files_;
};

const std::string leaf_opf =
    "<opf version=\"2.0\"><meshBDD><mesh Id=\"0\"><points>0 0 0 100 0 0 100 0 100</points><faces><face Id=\"0\">0 1 2</face></faces></mesh>"
    "</meshBDD><materialBDD/><shapeBDD><shape Id=\"0\"><meshIndex>0</meshIndex><materialIndex>0</materialIndex></shape></shapeBDD>"
    "<attributeBDD/><topology class=\"Plant\" scale=\"1\" id=\"1\"><decomp class=\"Leaf\" scale=\"2\" id=\"2\"><geometry class=\"Mesh\">"
    "<shapeIndex>0</shapeIndex><mat>1 0 0 0 0 1 0 0 0 0 1 0</mat></geometry></decomp></topology></opf>";

const std::string par_opt =
    "# by hand\nn 2\ns d 0.15\ne d 0.10   d 0.11 0.05  d 0.12 0.05\ne d 0.01   d 0.02 0.005  d 0.02 0.007 # second\n";
const std::string nir_opt = "n 2\ns d 0.35\ne d 0.40   d 0.41 0.45  d 0.41 0.45\ne d 0.42   d 0.43 0.44  d 0.43 0.44\n";
const std::string plants_can =
    "p 1 100001001000 3 0 0 100 10 0 100 0 10 100\np 1 100001000000 3 0 0 50 10 0 50 0 10 50\n"
    "p 1 200002001000 3 0 0 80 10 0 80 0 10 80\np 1 000000000000 3 0 0 0 90 0 0 0 90 0\n";

}  // namespace

TEST_CASE("An AMAP scene becomes a scene: plants in centimetres, turned, scaled, inclined and moved", "[format][import]") {
  Case files({{"opf/tree.opf", leaf_opf},
              {"orchard.ops",
               "# T xOrigin yOrigin zOrigin xSize ySize flat\nT 0 0 0.5 4 3 flat\n#[Archimed] coffee\n"
               "#sceneId plantId plantFileName x y z scale inclinationAzimut inclinationAngle stemTwist\n"
               "1\t1\topf/tree.opf\t1.0\t2\t0.5\t2\t0.3\t0.25\t1.57\n1 2 opf/tree.opf 3 1 0 0 0 0 0\n-1 1 1\n"}});
  const Scene scene = files.read(files.choice({"orchard.ops"}));
  REQUIRE(scene.plants.size() == 1);
  CHECK(scene.plants[0].name == "coffee");
  REQUIRE(scene.plants[0].placements.size() == 2);
  REQUIRE(scene.periodic);
  CHECK(scene.periodic->x_high == 4);
  CHECK(scene.periodic->y_high == 3);
  CHECK(scene.ground->height == 0.5);
  // PlantGeom.jl: about z by the twist, scaled, about (-sin azimuth, cos azimuth, 0) by the angle, moved
  const double azimuth = 0.3, angle = 0.25, twist = 1.57, c = std::cos(angle), s = std::sin(angle);
  const Vec3 axis{-std::sin(azimuth), std::cos(azimuth), 0};
  for (const Vec3& p : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.2, 0.3, 1}}) {
    Vec3 q{std::cos(twist) * p.x - std::sin(twist) * p.y, std::sin(twist) * p.x + std::cos(twist) * p.y, p.z};
    q *= 2.0;
    q = q * c + glm::cross(axis, q) * s + axis * glm::dot(axis, q) * (1 - c) + Vec3{1, 2, 0.5};
    CHECK(glm::length(scene.plants[0].placements[0].map.point(p) - q) < 1e-10);  // angles are written with 12 digits
  }
  CHECK(scene.plants[0].placements[1].map.linear == Mat3{1.0});  // a scale of 0 is none
  CHECK(scene.plants[0].plant->area() == Approx(0.5));           // a metre by a metre, halved
  REQUIRE(files.notes.size() == 3);
  CHECK(files.notes[1] == "1 objects have a scale of 0, which is none: taken for 1");

  auto choice = files.choice({"orchard.ops"});
  choice.finite = true;
  CHECK_FALSE(files.read(choice).periodic);
}

TEST_CASE("AMAP scenes without a column for the scale, with several scenes, or broken", "[format][import]") {
  const std::string head = "#sceneId plantId plantFileName x y z inclinationAzimut inclinationAngle stemTwist ignored\n";
  SECTION("no scale") {
    Case files({{"tree.opf", leaf_opf}, {"a.ops", head + "1\t1\ttree.opf\t1\t\t2\t\t0\t0\t0\t0.5\t0\n"}});
    const Scene scene = files.read(files.choice({"a.ops"}));
    CHECK(glm::length(scene.plants[0].placements[0].map.vector({1, 0, 0}) - Vec3{std::cos(0.5), std::sin(0.5), 0}) < 1e-10);
    CHECK_FALSE(scene.periodic);
  }
  SECTION("degrees") {
    Case files({{"tree.opf", leaf_opf}, {"a.ops", "1 1 tree.opf 0 0 0 1 0 0 90\n"}});
    CHECK(files.message([&] { files.read(files.choice({"a.ops"})); }) ==
          "a.ops:1: found an angle of 90; expected radians, at most a full turn; --degrees where the file has degrees");
    auto choice = files.choice({"a.ops"});
    choice.degrees = true;
    CHECK(glm::length(files.read(choice).plants[0].placements[0].map.vector({1, 0, 0}) - Vec3{0, 1, 0}) < 1e-10);
  }
  SECTION("inclined by more than half a turn") {
    Case files({{"tree.opf", leaf_opf}, {"a.ops", "1 1 tree.opf 0 0 0 1 0 5 0\n1 2 tree.opf 0 0 0 1 0 -1.2831853071795865 0\n"}});
    const Scene scene = files.read(files.choice({"a.ops"}));
    const auto &over = scene.plants[0].placements.at(0).map, &back = scene.plants[0].placements.at(1).map;
    CHECK(glm::length(over.vector({0, 0, 1}) - Vec3{std::sin(5.0), 0, std::cos(5.0)}) < 1e-10);
    CHECK(glm::length(over.vector({0, 0, 1}) - back.vector({0, 0, 1})) < 1e-10);
  }
  SECTION("letters of Latin-1") {
    Case files({{"p\u00eacher.opf", leaf_opf},
                {"a.ops",
                 "#[Archimed] P\xEA"
                 "cher\x7F\n1 1 p\xEA"
                 "cher.opf 0 0 0 1 0 0 0\n"},
                {"b.ops", "#[Archimed] P\u00eacher\n1 1 p\u00eacher.opf 0 0 0 1 0 0 0\n"}});
    CHECK(files.read(files.choice({"a.ops"})).plants[0].name == "P\u00eacher ");  // without the control character
    CHECK(files.notes.at(0).find("a.ops: its text is no UTF-8 and is taken for Windows-1252 (Latin-1)") != std::string::npos);
    CHECK(files.read(files.choice({"b.ops"})).plants[0].name == "P\u00eacher");
  }
  SECTION("several scenes") {
    Case files({{"tree.opf", leaf_opf}, {"a.ops", "1 1 tree.opf 0 0 0 1 0 0 0\n2 1 tree.opf 5 0 0 1 0 0 0\n"}});
    CHECK_THROWS_AS(files.read(files.choice({"a.ops"})), UsageError);
    auto choice = files.choice({"a.ops"});
    choice.scene_id = 2;
    CHECK(files.read(choice).plants[0].placements.at(0).map.translation == Vec3{5, 0, 0});
  }
  SECTION("broken") {
    Case files({{"a.ops", "1 1 tree.opf 0 0 x 1 0 0 0\n"},
                {"b.ops", "1 1 tree.opf 0 0 0 1 0 0 0\n"},
                {"c.ops", "T 0 0 0 0 3 flat\n"},
                {"d.ops", "# nothing\n"},
                {"e.ops", "1 1 tree.opf 0 0 0\n"}});
    const auto message = [&](const std::string& name) { return files.message([&] { files.read(files.choice({name})); }); };
    CHECK(message("a.ops") == "a.ops:1: found z \"x\"; expected a finite number");
    CHECK(message("b.ops") == "b.ops:1: found no file tree.opf; expected a plant file");
    const std::string endless = std::string(300, 'n') + ".opf";  // longer than a file system takes
    Case too_long({{"a.ops", "1 1 " + endless + " 0 0 0 1 0 0 0\n"}});
    CHECK(too_long.message([&] { too_long.read(too_long.choice({"a.ops"})); }) ==
          "a.ops:1: found no file " + endless + "; expected a plant file");
    CHECK(message("c.ops") == "c.ops:1: found a terrain from 0 0 to 0 3; expected boundaries above the origin");
    CHECK(message("d.ops") == "d.ops: found no plant; expected lines \"sceneId objectId file x y z scale ...\"");
    CHECK(message("e.ops") ==
          "e.ops:1: found 6 fields; expected 10: sceneId, objectId, file, x, y, z, scale, inclinationAzimut, inclinationAngle, rotation");
  }
}

TEST_CASE("A CARIBU case becomes a scene with the optics of every species", "[format][import]") {
  Case files({{"plants.can", plants_can},
              {"par.opt", par_opt},
              {"nir.opt", nir_opt},
              {"zenith.light", "2.5 0 0 -1\n"},
              {"cell.8", " 0 0\n 100 90\n"}});
  auto choice = files.choice({"plants.can", "par.opt", "nir.opt", "zenith.light", "cell.8"});
  choice.unit = "cm";
  const Scene scene = files.read(choice);
  CHECK(scene.bands == std::vector<std::string>{"PAR", "NIR"});
  REQUIRE(scene.periodic);
  CHECK(scene.periodic->x_high == 1.0);
  CHECK(scene.periodic->y_high == 0.9);
  REQUIRE(scene.states.size() == 1);
  REQUIRE(scene.states[0].sun);
  CHECK(scene.states[0].sun->irradiance == std::vector<double>{2.5, 2.5});
  CHECK(scene.states[0].sun->angular_diameter_deg == 0.0);
  const auto& plant = scene.plants.at(0);
  const auto optics_of = [&](std::size_t shape) { return scene.optics[plant.shape_optics.at(shape)]; };
  CHECK(optics_of(0).reflectance_front == std::vector<float>{0.11f, 0.41f});
  CHECK(optics_of(0).reflectance_back == std::vector<float>{0.12f, 0.41f});
  CHECK(optics_of(0).transmittance == std::vector<float>{0.05f, 0.45f});
  CHECK(optics_of(1).reflectance_front == std::vector<float>{0.10f, 0.40f});
  CHECK(optics_of(1).transmittance == std::vector<float>{0.0f, 0.0f});
  CHECK(optics_of(2).transmittance[0] == Approx(0.006f));  // the mean of both sides, with a note
  CHECK(optics_of(3).reflectance_front == std::vector<float>{0.15f, 0.35f});
  REQUIRE(files.notes.size() == 1);
  CHECK_FALSE(scene.ground);
  choice.soil = true;
  const Scene with_soil = files.read(choice);
  REQUIRE(with_soil.ground);
  CHECK(with_soil.ground->optics.reflectance_front == std::vector<float>{0.15f, 0.35f});
}

TEST_CASE("Directions of a .light file become the sky they stand for, a sun, or states", "[format][import]") {
  // a turtle of our own: rings of equal steps of the cosine, with the light of a sky model in each piece
  const auto turtle = [](auto radiance) {
    std::string text;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 12; ++j) {
        const double z = (i + 0.5) / 8, s = std::sqrt(1 - z * z), a = 2 * pi * j / 12;
        text += std::to_string(radiance(z) * z) + " " + std::to_string(-s * std::cos(a)) + " " + std::to_string(-s * std::sin(a)) + " " +
                std::to_string(-z) + "\n";
      }
    return text;
  };
  const std::string overcast = turtle([](double z) { return 1 + 2 * z; }), uniform = turtle([](double) { return 1.0; });
  Case files({{"plants.can", plants_can},
              {"par.opt", par_opt},
              {"overcast.light", overcast},
              {"uniform.light", uniform},
              {"both.light", uniform + "60 -0.6 0 -0.8\n"},
              {"day.light", "1 -0.8 0 -0.6\n2 0 0 -1\n\n0 0.1 0 -1\n1.5 0.8 0 -0.6\n"}});
  const auto state = [&](const std::string& light, bool apart = false) {
    auto choice = files.choice({"plants.can", "par.opt", light});
    choice.light_states = apart;
    return files.read(choice).states;
  };
  auto states = state("overcast.light");
  REQUIRE(states.size() == 1);
  REQUIRE(states[0].sky);
  CHECK(states[0].sky->model == SkyModel::standard_overcast);
  CHECK_FALSE(states[0].sun);
  double total = 0;
  for (int i = 0; i < 8; ++i) total += 12 * (1 + 2 * (i + 0.5) / 8) * (i + 0.5) / 8;
  CHECK(states[0].sky->irradiance[0] == Approx(total).epsilon(1e-5));  // six decimals
  states = state("both.light");
  REQUIRE(states[0].sky);
  REQUIRE(states[0].sun);
  CHECK(states[0].sky->model == SkyModel::uniform);
  CHECK(states[0].sun->irradiance[0] == Approx(60 / 0.8));
  CHECK(states[0].sun->direction.x == Approx(0.6));
  states = state("day.light");
  REQUIRE(states.size() == 3);  // a direction without energy is left out
  CHECK(states[0].duration_s == 1.0);
  CHECK(states[0].sun->irradiance[0] == Approx(1 / 0.6));
  CHECK(state("uniform.light", true).size() == 96);
}

TEST_CASE("A .light of many directions is one sky, whatever its azimuths; suns stay suns", "[format][import]") {
  // CARIBU's own discretisation: 18 zeniths and 36 azimuths
  const auto rings = [](auto radiance) {
    std::string text;
    for (int i = 0; i < 18; ++i)
      for (int j = 0; j < 36; ++j) {
        const double low = i * pi / 36, high = (i + 1) * pi / 36, zenith = 0.5 * (low + high), a = 2 * pi * (j + 0.5) / 36;
        const double x = std::sin(zenith) * std::cos(a), y = std::sin(zenith) * std::sin(a), z = std::cos(zenith);
        const double cosines = 0.5 * (std::sin(high) * std::sin(high) - std::sin(low) * std::sin(low)) * 2 * pi / 36;
        text += fmt::format("{} {} {} {}\n", radiance(Vec3{x, y, z}) * cosines, -x, -y, -z);
      }
    return text;
  };
  const std::string overcast = rings([](const Vec3&d) { return 1 + 2 * d.z; }), uniform = rings([](const Vec3&) { return 1.0; }),
                    eastern = rings([](const Vec3&d) { return 1 + 0.9 * d.x; });
  std::string day;
  for (int h = 0; h < 12; ++h) day += fmt::format("1 {} -0.3 -{}\n", std::cos(pi * (h + 0.5) / 12), std::sin(pi * (h + 0.5) / 12));
  Case files({{"plants.can", plants_can},
              {"par.opt", par_opt},
              {"overcast.light", overcast},
              {"uniform.light", uniform},
              {"eastern.light", eastern},
              {"sunny.light", eastern + "30 -0.6 0 -0.8\n"},
              {"day.light", day}});
  const auto states = [&](const std::string& light) { return files.read(files.choice({"plants.can", "par.opt", light})).states; };
  CHECK(states("overcast.light").at(0).sky->model == SkyModel::standard_overcast);
  CHECK(states("uniform.light").at(0).sky->model == SkyModel::uniform);
  const auto one = states("eastern.light");
  REQUIRE(one.size() == 1);
  REQUIRE(one[0].sky->model == SkyModel::file);
  CHECK(one[0].sky->table->directions().size() == 648);
  CHECK(one[0].sky->irradiance.at(0) == Approx(pi).epsilon(1e-3));
  for (const Vec3& d : {Vec3{0.6, 0, 0.8}, Vec3{-0.6, 0, 0.8}, Vec3{0, 0.6, 0.8}, Vec3{0.8, 0, 0.6}})
    CHECK(one[0].sky->relative_radiance(d) * pi == Approx(1 + 0.9 * d.x).margin(0.09));  // cells of five degrees of zenith
  const auto sunny = states("sunny.light");
  REQUIRE(sunny.size() == 1);
  CHECK(sunny[0].sun->irradiance.at(0) == Approx(30 / 0.8));
  CHECK(sunny[0].sky->model == SkyModel::file);
  CHECK(sunny[0].sky->irradiance.at(0) == Approx(pi).epsilon(1e-3));
  CHECK(states("day.light").size() == 12);  // the suns of a day leave most of the sky empty
}

TEST_CASE("CARIBU files that are broken or do not belong together", "[format][import]") {
  Case files({{"plants.can", plants_can},
              {"a.opt", "n 1\ns d 0.15\ne d 0.1 d 0.1 0.1 d 0.1 0.1\n"},
              {"b.opt", "e d 0.1 d 1.5 0.1 d 0.1 0.1\n"},
              {"c.opt", "n 3\ne d 0.1 d 0.1 0.1 d 0.1 0.1\n"},
              {"d.opt", "s d 0.1\ne d 0.1 d -1 -1 d -1 -1\ne d 0.1 d 0.1 0.1 d 0.1 0.1\n"},
              {"e.opt", "e s 0.1\n"},
              {"up.light", "1 0 0 1\n"},
              {"three.light", "1 0 0\n"},
              {"flat.light", "1e308 1e9 0 -1\n"},
              {"bright.light", "9e11 0 0 -1\n\n9e11 0 0 -1e308\n"},
              {"bad.8", "0 0 1\n"}});
  const auto message = [&](const std::vector<std::string>& names) { return files.message([&] { files.read(files.choice(names)); }); };
  CHECK(message({"plants.can", "a.opt"}) == "a.opt: found 1 species; expected species 2, which plants.can has");
  CHECK(message({"plants.can", "b.opt"}) ==
        "b.opt:1: found the upper side's reflectance = \"1.5\"; expected a number from 0 to 1, or -1 for none");
  CHECK(message({"plants.can", "c.opt"}) == "c.opt: found 1 species; expected the 3 that line n tells of");
  CHECK(message({"plants.can", "d.opt"}).find("d.opt:2: found no reflectance of the upper side of species 1") == 0);
  CHECK(message({"plants.can", "e.opt"}) == "e.opt:1: found \"s\"; expected \"d\": diffuse, the only kind of surface there is here");
  CHECK(message({"plants.can", "up.light"}) == "up.light:1: found direction 0 0 1; expected one that goes down (z below 0)");
  CHECK(message({"plants.can", "flat.light"}) ==
        "flat.light:1: found energy 1e+308; expected a beam, and a sum of all, of at most 1e+12 W m^-2");
  CHECK(message({"plants.can", "bright.light"}) ==
        "bright.light:3: found energy 900000000000; expected a beam, and a sum of all, of at most 1e+12 W m^-2");
  CHECK(message({"plants.can", "three.light"}).find("three.light:1: found") == 0);
  CHECK(message({"plants.can", "bad.8"}) == "bad.8: found 3 numbers; expected four: xmin ymin, and below xmax ymax");
  CHECK_THROWS_WITH(files.read(files.choice({"a.opt"})), "found no .can; expected one beside .opt, .light and .8");
  CHECK_THROWS_AS(files.read(files.choice({"plants.can", "plants.can"})), UsageError);
}
