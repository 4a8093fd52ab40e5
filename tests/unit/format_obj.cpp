#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

TEST_CASE("OBJ: groups are organs, polygons are fans, materials follow usemtl", "[format][obj]") {
  const TextFile file("leaves.obj",
                      "# two leaves\nmtllib sub/leaves.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.1 0 2\nv 1 0 2\nv 1 1 2 1.0\n"
                      "g leaf_1\nusemtl blade\nf 1/1/1 2//2 3/3 4\ng stem\nusemtl bark\nf -3 -2 \\\n -1\ng leaf_1\nf 1 3 2 # back\n");
  const Plant plant = read_plant(file.path);
  CHECK(plant.name == "leaves");
  REQUIRE(plant.structures.size() == 3);
  CHECK(plant.types == std::vector<std::string>{"plant", "organ"});
  CHECK(plant.structures[1].name == "leaf_1");
  CHECK(plant.structures[2].name == "stem");
  CHECK(plant.structures[2].parent == 0);
  REQUIRE(plant.meshes.size() == 1);
  using T = std::array<std::uint32_t, 3>;
  CHECK(plant.meshes[0].triangles == std::vector<T>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {0, 2, 1}});
  CHECK(plant.meshes[0].vertices[4].x == 0.1);  // rounded correctly, to the last bit
  REQUIRE(plant.shapes.size() == 3);            // the reopened leaf is a run of its own, of the same organ
  CHECK(plant.shapes[0].structure == 1);
  CHECK(plant.shapes[0].triangle_count == 2);
  CHECK(plant.shapes[1].structure == 2);
  CHECK(plant.shapes[2].structure == 1);
  CHECK(plant.shapes[2].first_triangle == 3);
  CHECK(plant.materials[plant.shapes[0].material] == "blade");
  CHECK(plant.materials[plant.shapes[1].material] == "bark");
}

TEST_CASE("OBJ: lengths are scaled by the unit", "[format][obj]") {
  const TextFile file("unit.obj", "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n");
  const Plant plant = read_plant(file.path, 0.01);
  CHECK(plant.area() == Approx(0.5).epsilon(1e-15));
  CHECK(plant.bounds().high.x == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("OBJ: objects that hold groups are structures between plant and organs", "[format][obj]") {
  const TextFile file("objects.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no tree\ng leaf\nf 1 2 3\no bush\ng leaf\nf 1 2 3\no stone\nf 1 2 3\n");
  const Plant plant = read_plant(file.path);
  REQUIRE(plant.structures.size() == 6);
  CHECK(plant.structures[1].name == "tree");
  CHECK(plant.types[plant.structures[1].type] == "object");
  CHECK(plant.structures[2].name == "leaf");
  CHECK(plant.structures[2].parent == 1);
  CHECK(plant.structures[4].parent == 3);
  CHECK(plant.structures[5].name == "stone");
  CHECK(plant.types[plant.structures[5].type] == "organ");
  CHECK(plant.structures[5].parent == 0);
}

TEST_CASE("OBJ: without groups the organs are what shares vertices, also if a face comes before its vertices", "[format][obj]") {
  const TextFile file("pieces.obj", "f 1 2 3\nf 5 6 7\nf 3 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 9 9 9\n");
  const Plant plant = read_plant(file.path);
  REQUIRE(plant.structures.size() == 3);
  REQUIRE(plant.shapes.size() == 3);
  CHECK(plant.shapes[0].structure == 1);
  CHECK(plant.shapes[1].structure == 2);
  CHECK(plant.shapes[2].structure == 1);
}

TEST_CASE("OBJ: Windows line ends and a missing material library do no harm", "[format][obj]") {
  const TextFile file("windows.obj", "mtllib absent.mtl\r\no a\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nusemtl green leaf\r\nf 1 2 3\r\n");
  const Plant plant = read_plant(file.path);
  CHECK(plant.structures[1].name == "a");
  CHECK(plant.materials[plant.shapes[0].material] == "green leaf");
}
