#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const std::string& text) {
  const TextFile file("bad.opf", text);
  return message_of(file, [&] { read_plant(file.path); });
}

std::string mesh(const std::string& inside) {
  return "<opf>\n<meshBDD><mesh Id=\"0\">\n" + inside + "</mesh></meshBDD></opf>";
}

std::string topology(const std::string& inside, const std::string& shape = "<meshIndex>0</meshIndex>") {
  return "<opf>\n<meshBDD><mesh Id=\"0\"><points>0 0 0 1 0 0 0 1 0</points><faces><face>0 1 2</face></faces></mesh></meshBDD>\n<shapeBDD>"
         "<shape Id=\"0\">" +
         shape +
         "</shape></shapeBDD>\n<attributeBDD><attribute name=\"Rank\" class=\"Integer\"/>"
         "<attribute name=\"Alive\" class=\"Boolean\"/><attribute name=\"Length\" class=\"Double\"/></attributeBDD>\n" +
         inside + "</opf>";
}

}  // namespace

TEST_CASE("Broken XML and wrong roots", "[format][opf]") {
  CHECK(message("<opf>\n<meshBDD>\n</opf>") == "bad.opf:3: found broken XML (Start-end tags mismatch); expected well-formed XML");
  CHECK(message("") == "bad.opf:1: found broken XML (No document element found); expected well-formed XML");
  CHECK(message("<scene/>") == "bad.opf:1: scene: found root element <scene>; expected <opf>");
  CHECK(message("<opf/>") == "bad.opf:1: opf: found no <topology>; expected the plant's structures");
  CHECK(message(topology("<topology class=\"Plant\"/>")) == "bad.opf: found no face; expected at least one triangle or polygon");
}

TEST_CASE("Broken OPF meshes and shapes are named with line and element", "[format][opf]") {
  CHECK(message(mesh("<points>0 0 0 1</points><faces/>")) == "bad.opf:3: points: found 4 numbers; expected three for each point");
  CHECK(message(mesh("<points>0 0\ninf</points><faces/>")) == "bad.opf:3: points: found number 3 = \"inf\"; expected a finite number");
  CHECK(message(mesh("<points>0 0 0,5</points><faces/>")) == "bad.opf:3: points: found number 3 = \"0,5\"; expected a finite number");
  CHECK(message(mesh("<points>0 0 0</points>")) == "bad.opf:2: mesh: found no <faces>; expected a list of faces");
  CHECK(message(mesh("<points>0 0 0</points><faces>\n<face>0 0 1</face></faces>")) ==
        "bad.opf:4: face: found point index 1; expected 0 to 0 (the mesh has 1 points)");
  CHECK(message(mesh("<points>0 0 0</points><faces><face>0 0</face></faces>")) ==
        "bad.opf:3: face: found a face with 2 corners; expected at least three");
  CHECK(message(mesh("<points>0 0 0</points><faces>0 0 0 0</faces>")) ==
        "bad.opf:3: faces: found 4 point indices; expected three for each triangle, or <face> elements");
  CHECK(message("<opf><meshBDD><mesh><faces/></mesh></meshBDD></opf>") == "bad.opf:1: mesh: found no Id; expected Id=\"number\"");
  CHECK(message("<opf><meshBDD><mesh Id=\"0\"><faces/></mesh>\n<mesh Id=\"0\"><faces/></mesh></meshBDD></opf>") ==
        "bad.opf:2: mesh: found a second mesh with Id 0; expected every Id once");
  CHECK(message("<opf><meshBDD><mesh Id=\"0\" enableScale=\"2\"><faces/></mesh></meshBDD></opf>") ==
        "bad.opf:1: mesh: found enableScale=\"2\"; expected \"true\" or \"false\"");
  CHECK(message(topology("", "<meshIndex>1</meshIndex>")) == "bad.opf:3: meshIndex: found mesh 1; expected the Id of a mesh in meshBDD");
  CHECK(message(topology("", "")) == "bad.opf:3: shape: found no <meshIndex>; expected the Id of a mesh");
}

TEST_CASE("Broken OPF topologies are named with line and element", "[format][opf]") {
  const auto plant = [](const std::string& inside) { return message(topology("<topology class=\"Plant\">\n" + inside + "</topology>")); };
  CHECK(message(topology("<topology/>")) == "bad.opf:5: topology: found no class; expected class=\"name\"");
  CHECK(plant("<geometry><shapeIndex>0</shapeIndex><mat>1 0 0</mat></geometry>") ==
        "bad.opf:6: mat: found 3 numbers; expected 12: three rows of four");
  CHECK(plant("<geometry><shapeIndex>0</shapeIndex></geometry>") ==
        "bad.opf:6: geometry: found no <mat>; expected 12 numbers: three rows of four");
  CHECK(plant("<geometry><mat>1 0 0 0 0 1 0 0 0 0 NaN 0</mat></geometry>") ==
        "bad.opf:6: mat: found number 11 = \"NaN\"; expected a finite number");
  const std::string mat = "<mat>1 0 0 0 0 1 0 0 0 0 1 0</mat>";
  CHECK(plant("<geometry>" + mat + "\n<shapeIndex>3</shapeIndex></geometry>") ==
        "bad.opf:7: shapeIndex: found shape 3; expected the Id of a shape in shapeBDD");
  CHECK(plant("<geometry>" + mat + "<shapeIndex>0</shapeIndex><dUp>inf</dUp></geometry>") ==
        "bad.opf:6: dUp: found \"inf\"; expected a finite number, or NaN for none");
}
