#include <catch2/catch.hpp>

#include <memory>

#include <sunfleck/scene/counts.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

/// A plant of two leaves: a triangle and a pair of triangles, each half a square metre.
std::shared_ptr<const Plant> small_plant() {
  auto plant = std::make_shared<Plant>();
  Plant& p = *plant;
  p.name = "small";
  const auto type = p.type_index("leaf");
  p.material_index("");
  p.structures.resize(3);
  for (std::uint32_t leaf : {1u, 2u}) {
    p.structures[leaf].parent = 0;
    p.structures[leaf].type = type;
  }
  p.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}});
  Shape one;
  one.structure = 1;
  one.triangle_count = 1;
  Shape two;
  two.structure = 2;
  two.triangle_count = 2;
  two.placement = Affine::translate({0, 0, 1});
  p.shapes = {one, two};
  return plant;
}

Scene nested_scene() {
  Scene scene;
  scene.bands = {"PAR"};
  scene.states.resize(1);
  scene.optics = {{"leaf", {0.1f}, {0.1f}, {0.1f}}};
  const auto plant = small_plant();
  scene.plants = {{"a", plant, {0, 0}, "", {{Affine{}}}}, {"b", plant, {0, 0}, "", {}}};
  GroupEntry row{"row", {{false, 0, {}}, {false, 1, {Affine::translate({2, 0, 0})}}}, {}};
  GroupEntry tile{"tile",
                  {{true, 0, {}}, {true, 0, {Affine::translate({0, 2, 0})}}, {false, 1, {Affine::translate({4, 0, 0})}}},
                  {{Affine{}}, {Affine::translate({9, 0, 0})}}};
  scene.groups = {row, tile};
  scene.ground = Ground{};
  scene.ground->cells = {2, 3};
  scene.ground->optics = {"ground", {0.1f}, {0.1f}, {0.0f}};
  return scene;
}

}  // namespace

TEST_CASE("counts of a scene of nested groups are those of its expansion", "[scene]") {
  const Scene scene = nested_scene();
  const SceneCounts counts = count(scene);
  CHECK(counts.copies == std::vector<std::uint64_t>{5, 6});  // a: 1 + 2 tiles x 2 rows; b: 2 tiles x (2 rows + 1)
  CHECK(counts.plant_facets == 33);
  CHECK(counts.unique_facets == 3);  // one plant under two names
  CHECK(counts.ground_facets == 12);
  CHECK(counts.leaf_area == Approx(16.5));
  const FacetScene facets = expand(scene);
  CHECK(counts.facets() == facets.size());
  CHECK(counts.organs == facets.organs.size());
}
