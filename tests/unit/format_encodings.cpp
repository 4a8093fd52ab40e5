// A byte-order mark, UTF-16, Latin-1: every text format as without them, and names as UTF-8.
#include <catch2/catch.hpp>

#include <pugixml.hpp>

#include <sunfleck/core/utf8.hpp>
#include <sunfleck/format/ies.hpp>
#include <sunfleck/format/import_scene.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/species_toml.hpp>
#include <sunfleck/format/write_opf.hpp>
#include <sunfleck/policy/policy_toml.hpp>

#include "places.hpp"
#include "scene_files.hpp"

using namespace sunfleck;

namespace {

const std::string mark = "\xEF\xBB\xBF";

/// ASCII as UTF-16 with its mark.
std::string utf16(const std::string& text, bool big, bool marked = true) {
  std::string out = !marked ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big) out += '\0';
    out += c;
    if (!big) out += '\0';
  }
  return out;
}

std::vector<std::string> disguises(const std::string& text) {
  return {mark + text, utf16(text, false), utf16(text, true), utf16(text, false, false)};
}

const std::string opf_head =
    "<opf version=\"2.0\"><meshBDD><mesh Id=\"0\"><points>0 0 0 1 0 0 0 1 0</points><faces><face>0 1 2</face></faces>"
    "</mesh></meshBDD><shapeBDD><shape Id=\"0\"><meshIndex>0</meshIndex></shape></shapeBDD>";
const std::string opf_geometry = "<geometry><shapeIndex>0</shapeIndex><mat>1 0 0 0 0 1 0 0 0 0 1 0</mat></geometry>";

std::string opf(const std::string& declaration, const std::string& name) {
  return declaration + opf_head +
         "<attributeBDD><attribute name=\"Name\" class=\"String\"/></attributeBDD><topology class=\"Plant\"><decomp "
         "class=\"Leaf\"><Name>" +
         name + "</Name>" + opf_geometry + "</decomp></topology></opf>";
}

const std::string sky_scene =
    "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1.0 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
    "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { file = \"p.csv\" } ]\n";

}  // namespace

TEST_CASE("Plant files with a byte-order mark or in UTF-16 are read as without", "[format][encodings]") {
  const std::vector<std::pair<std::string, std::string>> files{
      {"v.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 5 5 0\ng leaf\nusemtl green\nf 1 2 3\n"},
      {"o.obj", "o leaf\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl green\nf 1 2 3\no stem\nf 1 3 2\n"},
      {"p.can", "p 1 100001001000 3 0 0 0 1 0 0 1 1 0\n"},
      {"p.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list "
       "uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"},
      {"p.opf", opf("", "tip")}};
  for (const auto& [name, text] : files) {
    const TextFile plain(name, text);
    const Plant expected = read_plant(plain.path);
    for (const auto& disguised : disguises(text)) {
      const TextFile file(name, disguised);
      INFO(name);
      const Plant plant = read_plant(file.path);
      CHECK(plant.area() == expected.area());
      CHECK(plant.materials == expected.materials);
      REQUIRE(plant.structures.size() == expected.structures.size());
      for (std::size_t s = 0; s < plant.structures.size(); ++s) CHECK(plant.structures[s].name == expected.structures[s].name);
      CHECK(plant.notes.empty());
    }
  }
  const TextFile broken("b.obj",
                        "\xFF\xFE"
                        "v");
  CHECK(message_of(broken, [&] { read_plant(broken.path); }) ==
        "b.obj: found bytes that are no UTF-16LE (at byte 0); expected text in that character set");
}

TEST_CASE("Scenes, positions, species, policies and photometric files likewise", "[format][encodings]") {
  const std::string positions = "x,y,z,turn\n0,0,0,0\n1,1,0,90\n", leaf = "g leaf\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  std::ifstream in(std::string(SUNFLECK_SOURCE_DIR) + "/plants/maize.toml");
  const std::string species{std::istreambuf_iterator<char>(in), {}},
      policy = "[type.leaf]\nparameters = { area = [0, 1] }\n",
      lamp = "IESNA:LM-63\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n1 0\n";
  const TextFile plain("s.toml", species);
  for (std::size_t d = 0; d < 4; ++d) {
    INFO(d);
    const SceneFiles scene(disguises(sky_scene)[d], {{"leaf.obj", disguises(leaf)[d]}, {"p.csv", disguises(positions)[d]}});
    const Scene read = scene.read();
    CHECK(read.plants.at(0).placements.size() == 2);
    CHECK(read.bands == std::vector<std::string>{"PAR"});
    CHECK(read.text == sky_scene);  // as results keep it
    const TextFile grown("s.toml", disguises(species)[d]), classes("p.toml", disguises(policy)[d]), ies("l.ies", disguises(lamp)[d]);
    CHECK(is_species(grown.path));
    CHECK(read_species(grown.path).name == read_species(plain.path).name);
    CHECK(policy_text(read_policy(classes.path)).find("[type.leaf]") != std::string::npos);
    CHECK(read_ies(ies.path).candela == std::vector<double>{1, 0});
  }
  const SceneFiles scene("bands = [\"PAR\", \"\xE9\"]\n");
  CHECK(scene.message().find("scene.toml:1: not valid TOML: ") == 0);  // TOML is UTF-8
}

TEST_CASE("Scenes of other programs likewise", "[format][encodings][import]") {
  const std::string leaf = "g leaf\nv 0 0 0\nv 100 0 0\nv 100 100 0\nf 1 2 3\n", can = "p 1 100001001000 3 0 0 1 1 0 1 1 1 1\n",
                    ops = "1 1 p.obj 0.5 0.5 1 0.5 0 0 0\n1 2 p.obj 1.5 0.5 1 0.5 0 0 0\n",
                    terrain = "T 0 0 0 2 1 flat\n#[Archimed] coffee\n1 1 p.obj 0.5 0.5 1 0.5 0 0 0\n",
                    opt = "n 1\ns d 0.15\ne d 0.10 d 0.11 0.05 d 0.11 0.05\n", light = "2.5 0 0 -1\n", cell = "0 0\n2 2\n";
  for (std::size_t d = 0; d < 4; ++d) {
    INFO(d);
    const SceneFiles files("", {{"p.obj", leaf},
                                {"a.ops", disguises(ops)[d]},
                                {"t.ops", disguises(terrain)[d]},
                                {"c.can", disguises(can)[d]},
                                {"par.opt", disguises(opt)[d]},
                                {"z.light", disguises(light)[d]},
                                {"cell.8", disguises(cell)[d]}});
    const auto scene_of = [&](const std::vector<std::string>& names) {
      ImportChoice choice;
      choice.output = files.file().path;
      for (const auto& name : names) choice.files.push_back(files.file().folder() + "/" + name);
      std::ofstream(files.file().path) << import_scene(choice).text;
      return files.read();
    };
    CHECK(scene_of({"a.ops"}).plants.at(0).placements.size() == 2);
    const Scene with_terrain = scene_of({"t.ops"});
    CHECK(with_terrain.periodic.has_value());
    CHECK(with_terrain.plants.at(0).name == "coffee");
    const Scene caribu = scene_of({"c.can", "par.opt", "z.light", "cell.8"});
    CHECK(caribu.states.at(0).sun->irradiance.at(0) == 2.5);
    CHECK(caribu.optics.at(0).reflectance_front.at(0) == 0.11f);
    CHECK(caribu.periodic->x_high == 2.0);
  }
}

TEST_CASE("Names in Latin-1 and Windows-1252 become UTF-8, with a note where the file does not say so", "[format][encodings]") {
  const TextFile obj("p.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\ng bl\xE9\nusemtl feuille_\xE9t\xE9\nf 1 2 3\n");
  const Plant plant = read_plant(obj.path);
  CHECK(plant.structures.at(1).name == "blé");
  CHECK(plant.materials.back() == "feuille_été");
  REQUIRE(plant.notes.size() == 1);
  CHECK(plant.notes[0].find("p.obj: its text is no UTF-8 and is taken for Windows-1252 (Latin-1)") != std::string::npos);
  struct Xml {
    const char *declaration, *bytes, *name;
    bool note;
  };
  for (const Xml& xml : {Xml{"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>", "\xE9t\xE9", "été", false},
                         Xml{"<?xml version='1.0' encoding='windows-1252'?>", "\x9Cuvre", "œuvre", false},
                         Xml{"<?xml version=\"1.0\" encoding=\"ISO-8859-15\"?>", "\xBD\xA4", "œ€", false},
                         Xml{"<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "\xE9t\xE9", "été", true}, Xml{"", "\xE9t\xE9", "été", true},
                         Xml{"", "été", "été", false}}) {
    INFO(xml.declaration);
    const TextFile file("p.opf", opf(xml.declaration, xml.bytes)), out("out.opf", "");
    const Plant read = read_plant(file.path);
    CHECK(read.structures.at(1).name == xml.name);
    CHECK(read.notes.size() == (xml.note ? 1 : 0));
    // written back, the declaration names what the file has
    add_to_opf(file.path, {{"light"}, {{1.0, 2.0}}}, 2, out.path);
    pugi::xml_document document;
    REQUIRE(document.load_file(out.path.c_str()));
    CHECK(document.child("opf").child("topology").child("decomp").child_value("Name") == std::string(xml.name));
    std::ifstream in(out.path);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(is_utf8(text));
    const auto at = text.find("encoding=");
    CHECK((at == std::string::npos || text.compare(at, 16, "encoding=\"UTF-8\"") == 0));
  }
  const TextFile unknown("p.opf", opf("<?xml version=\"1.0\" encoding=\"klingon\"?>", "a"));
  CHECK(message_of(unknown, [&] { read_plant(unknown.path); }) ==
        "p.opf:1: encoding: found text in the character set \"klingon\"; expected UTF-8, UTF-16, ISO-8859-1, windows-1252, or another that "
        "iconv knows");
}

TEST_CASE("Control characters in names of plant files become blanks, with one note", "[format][encodings]") {
  const TextFile file("p.opf", opf("", "a&#10;b&#7;"));
  const Plant plant = read_plant(file.path);
  CHECK(plant.structures.at(1).name == "a b ");
  REQUIRE(plant.notes.size() == 1);
  CHECK(plant.notes[0].find("2 names with control characters") != std::string::npos);  // the attribute holds it too
}
