// Extents of plants and notes on what is hardly meant.
#include <catch2/catch.hpp>

#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/plant_sizes.hpp>

#include "scene_files.hpp"

using namespace sunfleck;

namespace {

const std::string head =
    "bands = [\"P\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { P = 100 }\n[optics.leaf]\nreflectance = { P = 0.1 }\n"
    "[ground]\nsize = [4, 4]\nheight = 1.0\nreflectance = { P = 0.1 }\n";

/// A box of two triangles from (0, 0, 0) to (1, 2, h).
std::string slope(double h) {
  const std::string z = std::to_string(h);
  return "v 0 0 0\nv 1 0 0\nv 1 2 " + z + "\nv 0 2 " + z + "\nf 1 2 3 4\n";
}

std::string plant(const std::string& place, const std::string& more = "") {
  return "[[plant]]\nname = \"p\"\nfile = \"p.obj\"\noptics = { \"*\" = \"leaf\" }\n" + more + "place = [ " + place + " ]\n";
}

}  // namespace

TEST_CASE("sizes are those of the copies as they stand, through groups too", "[scene][sizes]") {
  Scene scene = SceneFiles(head + plant("{ position = [0, 0, 1], scale = 3 }, { position = [5, 0, 2] }"), {{"p.obj", slope(0.5)}}).read();
  GroupEntry group;
  group.name = "g";
  group.members = {{false, 0, placed({{0, 0, 1}})}};
  group.placements = {placed({{0, 20, 0}, 90.0})};
  scene.groups = {group};
  const auto sizes = scene_sizes(scene);
  CHECK(sizes.plants[0].height == Approx(1.5));
  CHECK(sizes.plants[0].width == Approx(6.0));
  CHECK(sizes.plants[0].lowest == Approx(1.0));
  CHECK(sizes.plants[0].highest == Approx(2.5));
  CHECK(sizes.plants_box.low.x == Approx(-2.0));
  CHECK(sizes.plants_box.high.y == Approx(21.0));
  CHECK(sizes.all.low.x == Approx(-2.0));  // the ground reaches as far
  CHECK(scene.notes.empty());
}

TEST_CASE("a plant of 160 m, one below the ground: notes that say so", "[scene][sizes]") {
  CHECK(SceneFiles(head + plant("{ position = [0, 0, 1] }"), {{"p.obj", slope(160)}}).read().notes ==
        std::vector<std::string>{"plant \"p\" is 160 m high: is its `unit` right?"});
  CHECK(SceneFiles(head + plant("{ position = [0, 0, 1] }", "unit = \"cm\"\n"), {{"p.obj", slope(160)}}).read().notes.empty());
  CHECK(SceneFiles(head + plant("{ position = [0, 0, 0] }"), {{"p.obj", slope(0.5)}}).read().notes ==
        std::vector<std::string>{"plant \"p\" lies below the ground: its highest point is at 0.5 m, the ground at 1 m"});
}

TEST_CASE("leaves of several metres: a note", "[scene][sizes]") {
  auto p = std::make_shared<Plant>();
  p->structures.resize(2);
  p->type_index("plant");
  p->structures[1].parent = 0;
  p->structures[1].type = p->type_index("Leaf");
  p->material_index("");
  p->meshes.push_back({{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}});
  Shape shape;
  shape.structure = 1;
  shape.triangle_count = 1;
  p->shapes = {shape};
  Scene scene;
  scene.plants = {{"tree", p, {0}, "", {placed({{0, 0, 0}})}}};
  CHECK(notes_on_sizes(scene, scene_sizes(scene)) ==
        std::vector<std::string>{"plant \"tree\" has leaves of 5 m on average: is its `unit` right?"});
}
