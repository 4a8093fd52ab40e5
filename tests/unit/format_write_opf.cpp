#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include <format_files.hpp>
#include <sunfleck/format/read_plant.hpp>
#include <sunfleck/format/write_opf.hpp>
#include <sunfleck/plant/build.hpp>

using namespace sunfleck;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A stem, a leaf in two pieces, a mirrored copy of one piece, all with attributes of every kind.
Plant small() {
  Plant plant = empty_plant("tree", {}, "Individual");
  const auto axis = add_structure(plant, 0, "Axis", "trunk"), leaf = add_structure(plant, axis, "Leaf", "l1"),
             other = add_structure(plant, axis, "Leaf", "l2");
  set_attribute(plant, axis, "link", std::string("branch"));
  set_attribute(plant, leaf, "age", std::int64_t{3});
  set_attribute(plant, leaf, "Length", 0.125);
  set_attribute(plant, other, "sick leaf", true);
  set_attribute(plant, other, "note", std::string("a < b & \"c\""));
  plant.materials = {"green", "brown"};
  plant.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  const Affine turned = Affine::translate({0.1, 0.2, 1.0 / 3}) * Affine::turn(0.4);
  const Affine mirror{Mat3{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, Vec3{0, 0, 2}};
  plant.shapes = {
      {axis, 0, 0, 2, 1, Affine::scale(0.1)}, {leaf, 0, 0, 1, 0, turned}, {leaf, 0, 1, 1, 0, Affine{}}, {other, 0, 1, 1, 0, mirror}};
  return plant;
}

std::vector<Triangle> facets(const Plant& plant) {
  std::vector<Triangle> out;
  for (const auto& shape : plant.shapes)
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) out.push_back(shape_triangle(plant, shape, t));
  return out;
}

}  // namespace

TEST_CASE("A plant written as OPF is read back with its facets, structures and new numbers", "[format][opf][export]") {
  const Plant plant = small();
  const TextFile file("out.opf", "");
  write_opf(plant, {{"absorbed_W_PAR", "area_m2"}, {{none, 1.5, 2.25, 0.1}, {none, 3, none, 4}}}, file.path);
  const Plant back = read_plant(file.path, 0.01);
  REQUIRE(back.structures.size() == plant.structures.size());
  for (std::size_t s = 0; s < plant.structures.size(); ++s) {
    CHECK(back.structures[s].parent == plant.structures[s].parent);
    CHECK(back.types[back.structures[s].type] == plant.types[plant.structures[s].type]);
  }
  const auto before = facets(plant), after = facets(back);
  REQUIRE(after.size() == before.size());
  for (std::size_t f = 0; f < before.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(glm::length(after[f][c] - before[f][c]) < 4e-15);  // roundings: metres to centimetres and back
  CHECK(std::get<double>(*back.attribute(2, "absorbed_W_PAR")) == 2.25);
  CHECK(std::get<double>(*back.attribute(3, "area_m2")) == 4.0);
  CHECK_FALSE(back.attribute(2, "area_m2"));
  CHECK_FALSE(back.attribute(0, "absorbed_W_PAR"));
  CHECK(std::get<std::int64_t>(*back.attribute(2, "age")) == 3);
  CHECK(std::get<double>(*back.attribute(2, "Length")) == 0.125);
  CHECK(std::get<bool>(*back.attribute(3, "sick_leaf")));
  CHECK(std::get<std::string>(*back.attribute(3, "note")) == "a < b & \"c\"");
  CHECK(std::get<std::string>(*back.attribute(1, "link")) == "branch");
  CHECK(std::get<std::string>(*back.attribute(2, "link")) == "decomp");
  CHECK(back.materials[back.shapes[0].material] == "brown");
}

TEST_CASE("An OPF gains numbers and keeps everything else", "[format][opf][export]") {
  const std::string text =
      "<?xml version=\"1.0\"?>\n<!-- by hand --><opf version=\"2.0\">\n<meshBDD><mesh Id=\"0\" enableScale=\"true\"><points>0 0 0 1 0 0 1 "
      "1 0</points>"
      "<faces><face Id=\"0\">0 1 2</face></faces></mesh></meshBDD><materialBDD/><shapeBDD><shape Id=\"0\"><meshIndex>0</meshIndex>"
      "<materialIndex>0</materialIndex></shape></shapeBDD>\n<attributeBDD><attribute name=\"Width\" class=\"Double\"/><attribute "
      "name=\"old\" "
      "class=\"Double\"/></attributeBDD>\n<topology class=\"Individual\" scale=\"1\" id=\"1\"><decomp class=\"Leaf\" scale=\"2\" "
      "id=\"2\"><Width>2.5</Width>"
      "<old>7</old><geometry class=\"Mesh\"><shapeIndex>0</shapeIndex><mat>1 0 0 0 0 1 0 0 0 0 1 "
      "0</mat><dUp>0.5</dUp><dDwn>2</dDwn></geometry>"
      "</decomp><follow class=\"Leaf\" scale=\"2\" id=\"3\"/></topology></opf>\n";
  const TextFile file("in.opf", text), out("out.opf", "");
  add_to_opf(file.path, {{"absorbed_W_PAR", "old"}, {{none, 12.5, none}, {none, 8, none}}}, 3, out.path);
  const Plant before = read_plant(file.path), after = read_plant(out.path);
  CHECK(std::get<double>(*after.attribute(1, "absorbed_W_PAR")) == 12.5);
  CHECK(std::get<double>(*after.attribute(1, "old")) == 8.0);
  CHECK(std::get<double>(*after.attribute(1, "Width")) == 2.5);
  CHECK(std::get<std::string>(*after.attribute(2, "link")) == "follow");
  const auto was = facets(before), is = facets(after);
  REQUIRE(was.size() == is.size());
  CHECK(was[0] == is[0]);  // tapered as before
  std::ifstream in(out.path);
  const std::string written{std::istreambuf_iterator<char>(in), {}};
  CHECK(written.find("<!-- by hand -->") != std::string::npos);
  CHECK(written.find("<attribute name=\"absorbed_W_PAR\" class=\"Double\"") != std::string::npos);
  CHECK(message_of(file, [&] {
          add_to_opf(file.path, {{"a"}, {{1, 2}}}, 2, out.path);
        }) == "in.opf: topology: found 3 structures; expected the 2 of the plant that was solved");
  CHECK(message_of(file, [&] { add_to_opf(file.path + "x", {}, 0, out.path); }) ==
        "in.opfx: found no such file; expected an existing file");
}

TEST_CASE("A plant of another format keeps the names of its organs as OPF, and attributes whose elements would be one",
          "[format][opf][export]") {
  const TextFile obj("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng flag leaf\nf 1 2 3\ng blé\nf 1 3 2\n"), file("out.opf", "");
  Plant plant = read_plant(obj.path);
  set_attribute(plant, 1, "a b", 1.0);
  set_attribute(plant, 1, "a_b", 2.0);
  set_attribute(plant, 1, "geometry", 3.0);
  write_opf(plant, {{"area_m2"}, {{none, 1, 2}}}, file.path);
  const Plant back = read_plant(file.path);
  CHECK(back.structures.at(1).name == "flag leaf");
  CHECK(back.structures.at(2).name == "blé");
  CHECK(std::get<double>(*back.attribute(1, "a_b_2")) == 1.0);
  CHECK(std::get<double>(*back.attribute(1, "a_b")) == 2.0);
  CHECK(std::get<double>(*back.attribute(1, "_geometry")) == 3.0);
  CHECK(back.facet_count() == 2);
}
