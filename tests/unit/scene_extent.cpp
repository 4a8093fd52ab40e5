// How large, how far apart and how wide things of a scene may be.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/sky.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/extent.hpp>
#include <sunfleck/scene/facet_rows.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

/// Square leaves of one plant, of so many metres, at these places.
Scene leaves(double size, const std::vector<Placement>& places) {
  Scene scene;
  scene.bands = {"PAR"};
  LightState noon;
  noon.name = "noon";
  noon.sun = Sun{direction_from_angles(60.0, 180.0), {400.0}};
  scene.states = {noon};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.05})};
  const Mesh leaf{{{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  scene.plants = {plant_entry("leaf", make_plant(leaf, "leaf", "leaf"), 0, places)};
  return scene;
}

std::string refusal(const Scene& scene) {
  try {
    check_scene(scene);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(std::string("scene in memory: ").size());
  }
  return {};
}

Scene with_sensor(const SensorGrid& grid) {
  Scene scene = leaves(1.0, {placed({})});
  scene.sensors.push_back({"below", grid});
  return scene;
}

}  // namespace

TEST_CASE("copies that stand where single precision cannot tell their corners apart are refused by name", "[scene]") {
  CHECK(refusal(leaves(1.0, {placed({}), placed({{0, 0, 1e5}})})).empty());
  CHECK(refusal(leaves(1.0, {placed({}), placed({{0, 0, 9e7}})})) ==
        "plant[0].place[0]: found a plant of 1 m that stands 4.5e+07 m from the middle of the scene; expected plants at most 4000000 times "
        "their size from it: single precision tells their corners apart no farther");
  // far from the origin, but near each other
  CHECK(refusal(leaves(1.0, {placed({{5e6, 4e5, 0}}), placed({{5e6 + 10, 4e5, 0}})})).empty());
  // small beside large: the scales of copies count
  CHECK(refusal(leaves(1.0, {placed({{0, 0, 0}, 0, 1e-7}), placed({{10, 0, 0}})})).find("plant[0].place[0]: found a plant of 1e-07 m") ==
        0);
  Scene grouped = leaves(1.0, {});
  grouped.groups.push_back({"pair", {{false, 0, placed({})}, {false, 0, placed({{0, 0, 9e7}})}}, {placed({})}});
  CHECK(refusal(grouped).find("group[0].place[0]: found a plant of 1 m") == 0);
}

TEST_CASE("sensors stand where rays from them can be aimed at the scene", "[scene]") {
  CHECK(refusal(with_sensor({-100.0, {5, 5}, {}, {}})).empty());
  CHECK(refusal(with_sensor({0.5, {5, 5}, std::array{1e8, 1e8}, {}})) ==
        "sensor[0].grid.size: found 5e+07 m, in a scene of 1.414 m; expected at most 1000000 times the scene's size from its middle");
  CHECK(refusal(with_sensor({0.5, {5, 5}, {}, std::array{0.0, 9e7}})).find("sensor[0].grid.center: found 9e+07 m") == 0);
}

TEST_CASE("plants out of proportion with their periodic cell are noted, and refused where nothing could be computed", "[scene]") {
  Scene scene = leaves(100.0, {placed({})});
  CHECK(notes_on_extent(scene).empty());
  CHECK(most_cells_covered(scene) == 1.0);
  scene.periodic = PeriodicCell{0, 0, 20, 20};
  CHECK(notes_on_extent(scene).empty());
  CHECK(most_cells_covered(scene) == Approx(25.0));
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  CHECK(refusal(scene).empty());
  CHECK(notes_on_extent(scene) ==
        std::vector<std::string>{
            "plant \"leaf\" is 100 m by 100 m, and the periodic cell 1 m by 1 m: it covers 10000 cells, and as many images "
            "of it overlap. Is its `unit` right?"});
  scene.plants[0].placements = {placed({{0, 0, 0}, 0, 10})};
  CHECK(refusal(scene) ==
        "plant[0]: found a plant of 1000 m by 1000 m, 1e+06 times the periodic cell of 1 m by 1 m; expected at most 100000 times (is its "
        "`unit` right?)");
  scene.plants[0].placements = {placed({{0, 0, 0}, 0, 0.01}), placed({{0, 0, 2e5}, 0, 0.1})};
  CHECK(refusal(scene) ==
        "domain.periodic: found a cell of 1 m by 1 m under a scene 2e+05 m high; expected a height of at most 10000 cells (is a plant's "
        "unit, "
        "or where it is placed, wrong?)");
}

TEST_CASE("cells of flat ground are made on request, with the names and the order of the result", "[scene]") {
  Scene scene = leaves(1.0, {placed({})});
  scene.ground = flat_ground({4, 2}, {1, 1}, {4, 2}, {0.1});
  scene.ground->height = 0.25;
  const PlacedScene at = place(scene);
  REQUIRE(at.ground.size() == 16);
  REQUIRE(at.ground.organs() == 8);
  CHECK(at.ground[0] == Triangle{Vec3{-1, 0, 0.25}, Vec3{0, 0, 0.25}, Vec3{0, 1, 0.25}});
  CHECK(at.ground[11] == Triangle{Vec3{0, 1, 0.25}, Vec3{1, 2, 0.25}, Vec3{0, 2, 0.25}});
  CHECK(at.ground.written_out()[11] == at.ground[11]);
  CHECK(at.ground.organ(11) == 5);
  CHECK(at.ground.organ_name(5) == "cell_1_1");
  const FacetRows rows(scene, at);
  CHECK(rows.organ_facets(1, 5) == std::vector<std::uint32_t>{10, 11});
  const auto names = organ_names(rows);
  CHECK(names.names.back() == "cell_3_1");
  CHECK(names.ground.name.size() == 8);
  // a mesh is one organ, which may share its name with one of a plant
  Mesh slope{{{0, 0, 0}, {4, 0, 0}, {4, 4, 1}, {0, 4, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  scene.ground->mesh = slope;
  const PlacedScene on_mesh = place(scene);
  CHECK(on_mesh.ground.organs() == 1);
  CHECK(on_mesh.ground.organ(1) == 0);
  CHECK(on_mesh.ground.organ_name(0) == "ground");
}

TEST_CASE("a part of very many copies is listed for estimates: of every plant and group alike", "[scene]") {
  std::vector<Placement> places;
  for (int i = 0; i < 1000; ++i) places.push_back(placed({{2.0 * i, 0, 0}}));
  Scene scene = leaves(1.0, places);
  scene.plants.push_back(scene.plants[0]);
  scene.plants.back().name = "other";
  scene.groups.push_back({"pair", {{false, 0, placed({})}, {false, 1, placed({{0, 5, 0}})}}, places});
  const PlacedScene all = place(scene), part = place(scene, {}, 400);
  CHECK(all.copies.size() == 4000);
  CHECK(all.share == 1.0);
  REQUIRE(part.copies.size() == 400);
  CHECK(part.share == 0.1);
  CHECK(part.paths[100] == "other[0]");
  CHECK(part.paths[399] == "pair[99]/other[0]");
  // one group that holds all of them is listed in part too
  scene.groups.back().placements = {placed({})};
  for (const auto& p : places) scene.groups.back().members.push_back({false, 0, p});
  CHECK(place(scene, {}, 400).copies.size() <= 801);
}
