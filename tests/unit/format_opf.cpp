#include <sunfleck/format/read_plant.hpp>

#include <map>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

/// A triangle in the plane z = 0 (mesh 4, tapers), the same that does not (mesh 5), a square (mesh 6); shapes 0, 1, 2.
std::string opf(const std::string& topology) {
  const std::string triangle = "<points>0 0 0\n2 1 0\n\t2 -1 0</points><faces><face Id=\"0\">0 2 1</face></faces></mesh>\n";
  return "<?xml version=\"1.0\"?>\n<opf version=\"2.0\">\n<meshBDD>\n<mesh name=\"\" Id=\"4\" enableScale=\"true\">" + triangle +
         "<mesh name=\"\" Id=\"5\" enableScale=\"false\">" + triangle +
         "<mesh Id=\"6\"><points>0 0 0 1 0 0 1 1 0 0 1 0</points><normals>0 0 1</normals><faces><face>0 1 2 "
         "3</face></faces></mesh></meshBDD>\n"
         "<materialBDD><material Id=\"7\" name=\"green\"/></materialBDD>\n<shapeBDD>"
         "<shape Id=\"0\"><name>a</name><meshIndex> 4 </meshIndex><materialIndex>7</materialIndex></shape>"
         "<shape Id=\"1\"><meshIndex>5</meshIndex><materialIndex>1</materialIndex></shape><shape "
         "Id=\"2\"><meshIndex>6</meshIndex></shape></shapeBDD>\n"
         "<attributeBDD><attribute name=\"Name\" class=\"String\"/><attribute name=\"Length\" class=\"Metre\"/>"
         "<attribute name=\"Rank\" class=\"Integer\"/><attribute name=\"Alive\" class=\"Boolean\"/></attributeBDD>\n" +
         topology + "</opf>\n";
}

std::string geometry(int shape, const std::string& mat, const std::string& up, const std::string& down) {
  return fmt::format("<geometry class=\"Mesh\"><shapeIndex>{}</shapeIndex><mat>{}</mat><dUp>{}</dUp><dDwn>{}</dDwn></geometry>", shape, mat,
                     up, down);
}

const std::string identity = "1 0 0 0\n 0 1 0 0\n 0 0 1 0";

}  // namespace

TEST_CASE("OPF: nesting, types, names and typed attributes", "[format][opf]") {
  const TextFile file(
      "plant.opf", opf("<topology class=\"Plant\" scale=\"1\" id=\"1\"><Name>rose</Name>"
                       "<decomp class=\"Axis\" scale=\"2\" id=\"2\"><Length>NaN</Length>"
                       "<decomp class=\"Leaf\" scale=\"3\" "
                       "id=\"5\"><Length>0.5</Length><Rank>3</Rank><Alive>True</Alive><Colour>0.25</Colour><Rank2>NA</Rank2>" +
                       geometry(0, identity, "1", "1") + "</decomp><follow class=\"Leaf\" scale=\"3\" id=\"4\">" +
                       geometry(2, identity, "NaN", "NaN") + "</follow></decomp><branch class=\"Axis\" scale=\"2\" id=\"9\"/></topology>"));
  const Plant plant = read_plant(file.path);
  CHECK(plant.name == "rose");
  REQUIRE(plant.structures.size() == 5);
  const auto type = [&](std::uint32_t s) { return plant.types[plant.structures[s].type]; };
  CHECK(type(0) == "Plant");
  CHECK(type(2) == "Leaf");
  CHECK(plant.structures[1].name == "Axis_2");
  CHECK(plant.structures[2].parent == 1);
  CHECK(plant.structures[3].parent == 1);
  CHECK(plant.structures[4].parent == 0);
  CHECK(plant.attribute(1, "Length") == nullptr);  // NaN is no value
  CHECK(std::get<std::int64_t>(*plant.attribute(1, "scale")) == 2);
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "id")) == 5);
  CHECK(std::get<double>(*plant.attribute(2, "Length")) == 0.5);
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "Rank")) == 3);
  CHECK(std::get<bool>(*plant.attribute(2, "Alive")));
  CHECK(std::get<double>(*plant.attribute(2, "Colour")) == 0.25);  // not listed: the type is that of its text
  CHECK(plant.attribute(2, "Rank2") == nullptr);
  CHECK(plant.facet_count() == 3);  // a triangle and a square
  CHECK(plant.materials[plant.shapes[0].material] == "green");
  CHECK(plant.materials[plant.shapes[1].material].empty());
}

TEST_CASE("OPF: the width runs from dDwn to dUp along x, and not at all where the mesh does not scale", "[format][opf]") {
  const std::string turned = "0 0 -1 10\n0 1 0 20\n3 0 0 30";  // x -> 3 up, z -> -x
  const TextFile file("taper.opf",
                      opf("<topology class=\"Plant\"><branch class=\"Leaf\">" + geometry(0, turned, "5", "7") +
                          "</branch><branch class=\"Leaf\">" + geometry(1, identity, "5", "7") + "</branch><branch class=\"Leaf\">" +
                          geometry(0, identity, "3", "3") + "</branch><branch class=\"Leaf\">" + geometry(2, identity, "1", "3") +
                          "</branch><branch class=\"Leaf\">" + geometry(0, identity, "5", "7") + "</branch></topology>"));
  const Plant plant = read_plant(file.path);
  REQUIRE(plant.shapes.size() == 5);
  const Triangle tapered = shape_triangle(plant, plant.shapes[0], 0);
  CHECK(tapered[0] == Vec3{10, 20, 30});
  CHECK(tapered[1] == Vec3{10, 15, 36});  // y = -1 at x = 2, the end where the width is dUp = 5
  CHECK(tapered[2] == Vec3{10, 25, 36});
  CHECK(shape_triangle(plant, plant.shapes[1], 0)[1] == Vec3{2, -1, 0});
  CHECK(shape_triangle(plant, plant.shapes[2], 0)[1] == Vec3{2, -3, 0});
  CHECK(shape_triangle(plant, plant.shapes[3], 1)[2] == Vec3{0, 3, 0});
  CHECK(plant.shapes[4].mesh == plant.shapes[0].mesh);  // one baked mesh for equal widths
  CHECK(plant.shapes[2].mesh != plant.shapes[0].mesh);
  CHECK(plant.meshes.size() == 4);
  const Affine& frame = plant.structures[1].frame;  // rigid, its z along the mesh's x, its x along the mesh's y
  CHECK(frame.linear[2] == Vec3{0, 0, 1});
  CHECK(frame.linear[0] == Vec3{0, 1, 0});
  CHECK(frame.translation == Vec3{10, 20, 30});
  CHECK(glm::determinant(frame.linear) == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("OPF: a mirroring matrix keeps fronts", "[format][opf]") {
  const TextFile file("mirror.opf", opf("<topology class=\"Plant\">" + geometry(1, "1 0 0 0 0 -1 0 0 0 0 1 0", "1", "1") + "</topology>"));
  const Plant plant = read_plant(file.path);
  CHECK(area_vector(shape_triangle(plant, plant.shapes[0], 0)).z == 2);  // the front stays above: mirrored as a solid is
  CHECK(glm::determinant(plant.structures[0].frame.linear) == Approx(-1.0).epsilon(1e-15));
}

TEST_CASE("OPF: a hundred thousand elements deep", "[format][opf]") {
  constexpr int depth = 100000;
  std::string topology = "<topology class=\"Plant\">";
  for (int i = 0; i < depth; ++i) topology += "<follow class=\"Metamer\">";
  topology += geometry(1, identity, "1", "1");
  for (int i = 0; i < depth; ++i) topology += "</follow>";
  const TextFile file("deep.opf", opf(topology + "</topology>"));
  const Plant plant = read_plant(file.path);
  CHECK(plant.structures.size() == depth + 1);
  CHECK(plant.structures.back().parent == depth - 1);
  CHECK(plant.shapes[0].structure == depth);
}

TEST_CASE("OPF: the coffee plant", "[format][opf][extra]") {
  const std::string path = extra_data("plants/coffee.opf");
  if (path.empty()) {
    WARN("skipped: SUNFLECK_EXTRA_DATA has no plants/coffee.opf");
    return;
  }
  const Plant plant = read_plant(path, 0.01);
  std::map<std::string, int> organs;
  double leaf_area = 0;
  std::size_t zero = 0;
  for (const auto& shape : plant.shapes) {
    const std::string& type = plant.types[plant.structures[shape.structure].type];
    ++organs[type];
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) {
      const double area = glm::length(area_vector(shape_triangle(plant, shape, t)));
      if (type == "Leaf") leaf_area += area;
      zero += area == 0;
    }
  }
  CHECK(organs["Leaf"] == 2179);
  CHECK(organs["Metamer"] == 1853);
  CHECK(organs.size() == 2);
  CHECK(plant.facet_count() == 118798);
  CHECK(plant.structures.size() == 4191);
  CHECK(zero > 0);                                   // kept as facets
  CHECK(leaf_area == Approx(5.948).margin(0.0005));  // m^2, published to three decimals
}

TEST_CASE("OPF: an attribute that its class does not allow is left out with one note a kind; light does not need it", "[format][opf]") {
  const auto read = [](const std::string& attributes) {
    const TextFile file("a.opf", opf("<topology class=\"Plant\"><decomp class=\"Leaf\" id=\"2\">" + attributes +
                                     geometry(0, identity, "1", "1") + "</decomp></topology>"));
    return read_plant(file.path);
  };
  for (const char* odd :
       {"<Length>1.0\t2.0\t3.0</Length>", "<Length>missing</Length>", "<Length>null</Length>", "<Length>Infinity</Length>",
        "<Length>0,5</Length>", "<Length>2026-06-21</Length>", "<Rank>3.5</Rank>", "<Rank>99999999999999999999</Rank>",
        "<Rank>missing</Rank>", "<Alive>maybe</Alive>", "<Unlisted>inf</Unlisted>"}) {
    INFO(odd);
    const Plant plant = read(odd);
    CHECK(plant.facet_count() == 1);
    REQUIRE(plant.notes.size() == 1);
    CHECK(plant.notes[0].find(": left out") != std::string::npos);
    for (const char* name : {"Length", "Rank", "Alive", "Unlisted"}) CHECK(plant.attribute(1, name) == nullptr);
  }
  for (const char* nothing : {"<Length>NaN</Length>", "<Length>NA</Length>", "<Rank/>", "<Name>2026-06-21</Name>"}) {
    INFO(nothing);
    CHECK(read(nothing).notes.empty());
  }
  CHECK(std::get<std::int64_t>(*read("<Rank>3.0</Rank>").attribute(1, "Rank")) == 3);
  CHECK(std::get<bool>(*read("<Alive>1</Alive>").attribute(1, "Alive")));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "<decomp class=\"Leaf\"><Length>0,5</Length></decomp>";
  const auto notes = read(many).notes;
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("\"0,5\" is not a finite number, as the class of the attribute says: left out, as are 999 more of this attribute") !=
        std::string::npos);
  const TextFile odd_id("a.opf",
                        opf("<topology class=\"Plant\" scale=\"one\" id=\"1.0\">" + geometry(0, identity, "1", "1") + "</topology>"));
  const Plant plant = read_plant(odd_id.path);
  CHECK(plant.structures[0].name == "Plant_1");
  CHECK(plant.attribute(0, "scale") == nullptr);
  CHECK(plant.notes.size() == 1);
}
