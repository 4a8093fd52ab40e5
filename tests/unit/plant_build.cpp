#include <sunfleck/plant/build.hpp>

#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>

using namespace sunfleck;

namespace {

const Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};

std::string message(const Mesh& mesh) {
  try {
    make_plant(mesh, "weed");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("A plant made in memory has one organ per mesh", "[plant]") {
  const Plant one = make_plant(triangle, "weed", "leaf");
  REQUIRE(one.structures.size() == 2);
  CHECK(one.structures[1].name == "weed");
  CHECK(one.types == std::vector<std::string>{"plant", "leaf"});
  const Plant two = make_plant({triangle, triangle}, "weed");
  REQUIRE(two.structures.size() == 3);
  CHECK(two.structures[2].name == "weed_2");
  CHECK(two.shapes[1].structure == 2);
  CHECK(two.facet_count() == 2);
}

TEST_CASE("Attributes are replaced, runs of triangles become shapes", "[plant]") {
  Plant plant = empty_plant("weed");
  set_attribute(plant, 0, "height", 1.0);
  set_attribute(plant, 0, "height", 2.0);
  CHECK(plant.structures[0].attributes.size() == 1);
  CHECK(std::get<double>(*plant.attribute(0, "height")) == 2.0);
  const auto a = add_structure(plant, 0, "leaf", "a"), b = add_structure(plant, 0, "leaf", "b");
  const auto none = plant.material_index(""), green = plant.material_index("green");
  Mesh mesh = triangle;
  mesh.triangles.resize(5, {0, 1, 2});
  add_mesh(plant, mesh, {a, a, b, a, a}, {none, none, none, none, green});
  REQUIRE(plant.shapes.size() == 4);
  CHECK(plant.shapes[0].triangle_count == 2);
  CHECK(plant.shapes[2].structure == a);
  CHECK(plant.shapes[3].first_triangle == 4);
  CHECK(plant.shapes[3].material == green);
  check_plant(plant);
}

TEST_CASE("A plant made of a broken mesh is refused", "[plant]") {
  CHECK(message({}) == "plant \"weed\": found no face; expected at least one triangle or polygon");
  Mesh bad = triangle;
  bad.triangles[0][2] = 3;
  CHECK(message(bad) == "plant \"weed\": found vertex index 3 in face 1; expected an index below the number of vertices, 3");
  bad = triangle;
  bad.vertices[1].x = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(bad) == "plant \"weed\": found vertex 2 = (nan, 0.000000, 0.000000); expected finite coordinates");
}
