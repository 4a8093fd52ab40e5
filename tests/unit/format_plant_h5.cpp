#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>
#include <sunfleck/plant/build.hpp>

#include "places.hpp"

using namespace sunfleck;

namespace {

bool same(const Affine& a, const Affine& b) {
  return a.linear == b.linear && a.translation == b.translation;
}

void check_same(const Plant& a, const Plant& b) {
  CHECK(a.name == b.name);
  CHECK(a.types == b.types);
  CHECK(a.attribute_names == b.attribute_names);
  CHECK(a.materials == b.materials);
  REQUIRE(a.structures.size() == b.structures.size());
  for (std::size_t i = 0; i < a.structures.size(); ++i) {
    const auto &s = a.structures[i], &t = b.structures[i];
    REQUIRE(s.parent == t.parent);
    REQUIRE(s.type == t.type);
    REQUIRE(s.name == t.name);
    REQUIRE(same(s.frame, t.frame));
    REQUIRE(s.attributes == t.attributes);
  }
  REQUIRE(a.meshes.size() == b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    REQUIRE(a.meshes[i].vertices == b.meshes[i].vertices);
    REQUIRE(a.meshes[i].triangles == b.meshes[i].triangles);
  }
  REQUIRE(a.shapes.size() == b.shapes.size());
  for (std::size_t i = 0; i < a.shapes.size(); ++i) {
    const auto &s = a.shapes[i], &t = b.shapes[i];
    REQUIRE((s.structure == t.structure && s.mesh == t.mesh && s.first_triangle == t.first_triangle));
    REQUIRE((s.triangle_count == t.triangle_count && s.material == t.material && same(s.placement, t.placement)));
  }
}

}  // namespace

TEST_CASE("A plant survives its HDF5 file bit by bit", "[format][h5]") {
  Mesh one{{{0, 0, 0}, {0.1, 0, 0}, {0, 1.0 / 3.0, 0}}, {{0, 1, 2}, {2, 1, 0}}};
  Mesh two{{{0, 0, 1e-300}, {1e6, 0, 0}, {0, 1, -0.0}, {4, 4, 4}}, {{3, 1, 2}}};
  Plant plant = make_plant({one, two}, "weed", "leaf");
  const auto axis = add_structure(plant, 0, "axis", "branch é");
  add_structure(plant, axis, "bud", "");
  plant.structures[axis].frame = Affine::turn(0.3) * Affine::translate({1, 2, 3});
  plant.shapes[1].placement = Affine::scale(0.7) * Affine::turn(1.0);
  plant.shapes[1].material = plant.material_index("bark");
  set_attribute(plant, 0, "alive", true);
  set_attribute(plant, 1, "rank", std::int64_t{-9007199254740993});  // no double holds it
  set_attribute(plant, 1, "length", 0.1);
  set_attribute(plant, axis, "note", std::string("a longer text, with punctuation"));
  set_attribute(plant, axis, "empty", std::string());
  set_attribute(plant, axis, "alive", false);
  const TextFile folder("anything", "");
  const std::string path = folder.folder() + "/weed.h5";
  write_plant_h5(plant, path);
  const Plant again = read_plant(path);
  CHECK(again.file == path);
  check_same(plant, again);

  write_plant_h5(plant, folder.folder() + "/twice.h5");
  const auto bytes = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  CHECK(bytes(path) == bytes(folder.folder() + "/twice.h5"));
}

TEST_CASE("A plant file is complete or absent", "[format][h5]") {
  const TextFile folder("anything", "");
  const Plant plant = make_plant(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  CHECK_THROWS_AS(write_plant_h5(plant, folder.folder() + "/absent/plant.h5"), OutputError);
  std::filesystem::create_directory(folder.folder() + "/taken.h5");
  CHECK_THROWS_AS(write_plant_h5(plant, folder.folder() + "/taken.h5"), OutputError);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.folder())) ++files;
  CHECK(files == 2);  // no temporary is left behind
}

TEST_CASE("A species read through the door grows and survives HDF5", "[format][h5]") {
  const Plant plant = read_plant(SUNFLECK_SOURCE_DIR "/plants/maize.toml");
  CHECK(plant.facet_count() > 100);
  const TextFile folder("anything", "");
  write_plant_h5(plant, folder.folder() + "/maize.h5");
  check_same(plant, read_plant(folder.folder() + "/maize.h5"));
}

TEST_CASE("The coffee plant survives HDF5", "[format][h5][extra]") {
  const std::string path = extra_data("plants/coffee.opf");
  if (path.empty()) {
    WARN("skipped: SUNFLECK_EXTRA_DATA has no plants/coffee.opf");
    return;
  }
  const Plant plant = read_plant(path, 0.01);
  const TextFile folder("anything", "");
  write_plant_h5(plant, folder.folder() + "/coffee.h5");
  check_same(plant, read_plant(folder.folder() + "/coffee.h5"));
}
