#include <sunfleck/format/read_plant.hpp>

#include <map>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

TEST_CASE("CAN: labels give plants, organs and optical species; polygons are fans in file order", "[format][can]") {
  const TextFile file(
      "field.can",
      "# comment\np 1 100002003007 4 0 0 0 1 0 0 1 1 0 0 1 0\n\n"
      "p 1 200002000001 3 0 0 0 1 0 0 0 0 1\np 1 100001003001 3 0 0 0 1 0 0 0 0 1\np 2 100002003008 5 3 0 0 0 2 0 0 0 0 2\n");
  const Plant plant = read_plant(file.path);
  REQUIRE(plant.structures.size() == 6);
  const auto type = [&](std::uint32_t s) { return plant.types[plant.structures[s].type]; };
  CHECK(type(0) == "canopy");
  CHECK(type(1) == "plant");
  CHECK(plant.structures[1].name == "plant_2");
  CHECK(type(2) == "leaf");
  CHECK(plant.structures[2].name == "leaf_3");
  CHECK(type(3) == "stem");
  CHECK(plant.structures[3].name == "stem");
  CHECK(plant.structures[4].name == "plant_1");
  CHECK(plant.structures[5].parent == 4);
  CHECK(std::get<std::string>(*plant.attribute(2, "label")) == "100002003007");
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "plant")) == 2);
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "leaf")) == 3);
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "optical_species")) == 1);
  CHECK(std::get<std::int64_t>(*plant.attribute(2, "transparency")) == 1);
  CHECK(std::get<std::int64_t>(*plant.attribute(3, "transparency")) == 0);
  REQUIRE(plant.shapes.size() == 4);
  CHECK(plant.shapes[0].structure == 2);
  CHECK(plant.shapes[0].triangle_count == 2);
  CHECK(plant.shapes[1].structure == 3);
  CHECK(plant.shapes[2].structure == 5);
  CHECK(plant.shapes[3].structure == 2);
  CHECK(plant.materials[plant.shapes[0].material] == "species_1");
  CHECK(plant.materials[plant.shapes[1].material] == "species_2");
}

TEST_CASE("CAN: a wheat field keeps every polygon", "[format][can][extra]") {
  const std::string path = extra_data("plants/canis_wheat_field1.can");
  if (path.empty()) {
    WARN("skipped: SUNFLECK_EXTRA_DATA has no plants/canis_wheat_field1.can");
    return;
  }
  const Plant plant = read_plant(path, 0.01);
  CHECK(plant.facet_count() == 6033);
  std::map<std::string, int> count;
  for (const auto& s : plant.structures) ++count[plant.types[s.type]];
  CHECK(count["plant"] == 16);
  CHECK(count["leaf"] + count["stem"] == 98);
  CHECK(plant.structures.size() == 115);
}
