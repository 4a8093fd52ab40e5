// Inputs that ask for far more than they bring: depth, copies, entities, devices, links.
#include <catch2/catch.hpp>

#include <chrono>

#include <sunfleck/format/read_plant.hpp>

#include "scene_files.hpp"

using namespace sunfleck;

namespace {

std::string opf(const std::string& points, const std::string& faces, const std::string& inside, const std::string& before = "") {
  return before + "<opf><meshBDD><mesh Id=\"0\" enableScale=\"true\"><points>" + points + "</points><faces>" + faces +
         "</faces></mesh></meshBDD><shapeBDD><shape Id=\"0\"><meshIndex>0</meshIndex></shape></shapeBDD>\n<topology class=\"Plant\">" +
         inside + "</topology></opf>";
}

std::string leaf(const std::string& up = "1", const std::string& down = "1") {
  return "<geometry><shapeIndex>0</shapeIndex><mat>1 0 0 0 0 1 0 0 0 0 1 0</mat><dUp>" + up + "</dUp><dDwn>" + down + "</dDwn></geometry>";
}

const std::string triangle = "0 0 0 1 0 0 0 1 0", face = "<face>0 1 2</face>";

std::string scene(const std::string& plant_file, const std::string& place) {
  return "bands = [\"a\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { a = 1 }\n[optics.l]\nreflectance = { a = 0.1 }\n[[plant]]\nname = "
         "\"p\"\nfile = "
         "\"" +
         plant_file + "\"\noptics = { \"*\" = \"l\" }\nplace = [ " + place + " ]\n";
}

}  // namespace

TEST_CASE("An OPF two hundred thousand structures deep", "[hostile][opf]") {
  constexpr int depth = 200'000;
  std::string inside, end;
  for (int i = 0; i < depth; ++i) {
    inside += "<decomp class=\"a\">";
    end += "</decomp>";
  }
  const TextFile file("deep.opf", opf(triangle, face, inside + leaf() + end));
  const Plant plant = read_plant(file.path);
  CHECK(plant.structures.size() == depth + 1);
  CHECK(plant.facet_count() == 1);
}

TEST_CASE("Entities of XML are not expanded and open no file", "[hostile][opf]") {
  const TextFile bomb("bomb.opf", opf("&b;", face, leaf(), "<!DOCTYPE opf [<!ENTITY a \"0 0 0 \"><!ENTITY b \"&a;&a;&a;\">]>"));
  CHECK(message_of(bomb, [&] { read_plant(bomb.path); }) == "bomb.opf:1: points: found number 1 = \"&b;\"; expected a finite number");
  const TextFile file("file.opf",
                      opf(triangle, face, "<Name>&x;</Name>" + leaf(), "<!DOCTYPE opf [<!ENTITY x SYSTEM \"file:///etc/hostname\">]>"));
  CHECK(read_plant(file.path).structures[0].name == "&x;");
}

TEST_CASE("Tapered copies are held against the size of their file", "[hostile][opf]") {
  std::string points, faces, inside;
  for (int i = 0; i < 4000; ++i) points += std::to_string(i % 7) + " 0 1 ";
  for (int i = 0; i < 4000; ++i) inside += leaf("1", std::to_string(i + 2));
  const TextFile file("taper.opf", opf(points, face, inside));
  const std::string message = message_of(file, [&] { read_plant(file.path); });
  CHECK(message.find("taper.opf: found tapered copies of meshes with more than") == 0);
  CHECK(message.find("expected fewer in a file of this size: organs of the same dUp and dDwn share one copy") != std::string::npos);
}

TEST_CASE("Devices are no files, by name or through a link", "[hostile]") {
  const SceneFiles csv(scene("leaf.obj", "{ file = \"/dev/zero\" }"), {{"leaf.obj", two_organs}});
  CHECK(csv.message().find("/dev/zero: found a device or socket; expected a file") != std::string::npos);
  const SceneFiles linked(scene("endless.obj", "{ position = [0, 0, 0] }"));
  std::filesystem::create_symlink("/dev/zero", linked.file().folder() + "/endless.obj");
  CHECK(linked.message().find("endless.obj: found a device or socket; expected a file") != std::string::npos);
}

TEST_CASE("What an OBJ names is never opened, be it a link or not there", "[hostile][obj]") {
  const TextFile file("plant.obj", "mtllib secret.mtl missing.mtl\n" + two_organs);
  std::filesystem::create_symlink("/dev/zero", file.folder() + "/secret.mtl");
  CHECK(read_plant(file.path).facet_count() == 4);
  const TextFile outside("plant.obj", "mtllib below/../../secret.mtl\n" + two_organs);
  CHECK(read_plant(outside.path).facet_count() == 4);
  CHECK(read_plant(outside.path).notes.size() == 1);  // it lies elsewhere, is not needed, and is not opened
}

TEST_CASE("A scene that names itself as a plant, and links in a circle", "[hostile][scene]") {
  const SceneFiles itself(scene("scene.toml", "{ position = [0, 0, 0] }"));
  CHECK(itself.message().find("scene.toml") == 0);
  const SceneFiles circle(scene("a.obj", "{ position = [0, 0, 0] }"));
  std::filesystem::create_symlink("b.obj", circle.file().folder() + "/a.obj");
  std::filesystem::create_symlink("a.obj", circle.file().folder() + "/b.obj");
  CHECK(circle.message().find("a.obj") != std::string::npos);
}
