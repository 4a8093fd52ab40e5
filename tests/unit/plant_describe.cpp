#include <sunfleck/plant/describe.hpp>

#include <catch2/catch.hpp>

#include <sunfleck/plant/build.hpp>

using namespace sunfleck;

TEST_CASE("A plant is summarised in numbers and words", "[plant]") {
  const Mesh leaf{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}}, {{0, 1, 2}, {0, 1, 1}}};
  Plant plant = make_plant({leaf, leaf}, "weed", "leaf");
  plant.file = "weed.obj";
  set_attribute(plant, 1, "rank", std::int64_t{3});
  plant.shapes[1].material = plant.material_index("green");
  plant.shapes[1].placement = Affine::scale(2.0);
  const PlantSummary s = summarize_plant(plant);
  CHECK(s.structures == 3);
  CHECK(s.organs == 2);
  CHECK(s.facets == 4);
  CHECK(s.zero_area_facets == 2);
  CHECK(s.area_m2 == 2.5);
  CHECK(s.bounds.high == Vec3{2, 2, 0});  // the unused vertex does not count
  REQUIRE(s.types.size() == 2);
  CHECK(s.types[0].organs == 0);
  CHECK(s.types[1].organs == 2);
  CHECK(s.types[1].facets == 4);
  CHECK(describe_plant(plant) ==
        "plant      weed (weed.obj)\n"
        "structures 3, of which 2 are organs\n"
        "  type  structures     organs     facets   area [m^2]\n"
        "  plant          1          0          0            0\n"
        "  leaf           2          2          4          2.5\n"
        "facets     4, 2 of them with zero area\n"
        "area       2.5 m^2, one side\n"
        "bounds     x 0 to 2 m, y 0 to 2 m, z 0 to 0 m\n"
        "meshes     2, placed 2 times\n"
        "materials  green\n"
        "attributes rank\n");
}
