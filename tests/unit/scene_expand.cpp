// Copies written out: order, paths, fronts, areas.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

/// A horizontal unit square, front upwards, with its corner at the origin; a second organ at height 1 of one triangle.
Plant little_plant() {
  Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  Mesh triangle{{{0, 0, 1}, {0.5, 0, 1}, {0, 0.25, 1.5}}, {{0, 1, 2}}};
  return make_plant({square, triangle}, "little", "leaf");
}

Scene little_scene() {
  Scene scene;
  scene.bands = {"PAR"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.05})};
  LightState state;
  state.sky = Sky{};
  state.sky->irradiance = {1.0};
  scene.states = {state};
  return scene;
}

FacetScene little_copy(const Placement& placement) {
  Scene scene = little_scene();
  scene.plants.push_back(plant_entry("p", little_plant(), 0, {placement}));
  check_scene(scene);
  return expand(scene);
}

/// 1e-12: a few roundings of numbers near 1.
bool near(const Vec3& a, const Vec3& b) {
  return glm::length(a - b) < 1e-12;
}

}  // namespace

TEST_CASE("A copy at rest keeps every coordinate to the bit", "[scene][expand]") {
  const Plant plant = little_plant();
  const FacetScene facets = little_copy(placed({}));
  REQUIRE(facets.size() == 3);
  std::size_t k = 0;
  for (const auto& shape : plant.shapes)
    for (std::uint32_t t = 0; t < shape.triangle_count; ++t) CHECK(facets.corners[k++] == shape_triangle(plant, shape, t));
  CHECK(facets.area == std::vector<float>{0.5f, 0.5f, static_cast<float>(0.25 * std::sqrt(0.0625 + 0.25))});
  CHECK(facets.organ == std::vector<std::uint32_t>{0, 0, 1});
  CHECK(facets.plant_facets == 3);
}

TEST_CASE("A rigid motion moves corners and normals and keeps areas", "[scene][expand]") {
  const FacetScene rest = little_copy(placed({})), moved = little_copy(placed({{3, -2, 5}, 90.0}));
  for (std::size_t f = 0; f < rest.size(); ++f) {
    CHECK(moved.area[f] == Approx(rest.area[f]).epsilon(1e-6));  // single precision
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = rest.corners[f][c];
      CHECK(near(moved.corners[f][c], Vec3{3 - p.y, -2 + p.x, 5 + p.z}));  // 90 degrees: x goes to y, seen from above counter-clockwise
    }
  }
}

TEST_CASE("A mirror keeps fronts fronts", "[scene][expand]") {
  Stance mirrored;
  mirrored.mirror = true;
  const FacetScene rest = little_copy(placed({})), mirror = little_copy(placed(mirrored));
  for (std::size_t f = 0; f < rest.size(); ++f) {
    const Vec3 n = area_vector(rest.corners[f]);
    CHECK(near(area_vector(mirror.corners[f]), Vec3{-n.x, n.y, n.z}));  // the front normal is mirrored like the leaf, not flipped
    CHECK(mirror.area[f] == rest.area[f]);
  }
  // A mirrored shape in a mirrored copy has its corners swapped not at all.
  Scene scene = little_scene();
  Plant plant = little_plant();
  plant.shapes[0].placement.linear[0][0] = -1;
  scene.plants.push_back(plant_entry("p", plant, 0, {placed(mirrored)}));
  CHECK(expand(scene).corners[0] == rest.corners[0]);
}

TEST_CASE("A scale multiplies areas by its square", "[scene][expand]") {
  Stance large;
  large.scale = 3.0;
  const FacetScene rest = little_copy(placed({})), scaled = little_copy(placed(large));
  for (std::size_t f = 0; f < rest.size(); ++f) CHECK(scaled.area[f] == Approx(9.0 * rest.area[f]).epsilon(1e-6));
  CHECK(near(scaled.bounds.high, Vec3{3, 3, 4.5}));
}

TEST_CASE("A tilt leans the vertical towards its azimuth", "[scene][expand]") {
  Stance stance;
  stance.tilt_deg = 30;
  stance.tilt_azimuth_deg = 90;  // east
  const double s = std::sin(std::numbers::pi / 6), c = std::cos(std::numbers::pi / 6);
  CHECK(near(placed(stance).map.vector({0, 0, 1}), Vec3{s, 0, c}));
  stance.tilt_azimuth_deg = 0;  // north
  CHECK(near(placed(stance).map.vector({0, 0, 1}), Vec3{0, s, c}));
  stance.turn_deg = 123;  // turned about its own vertical before it leans
  CHECK(near(placed(stance).map.vector({0, 0, 1}), Vec3{0, s, c}));
}

TEST_CASE("Facets come in scene order, and placements have paths", "[scene][expand]") {
  Scene scene = little_scene();
  const auto at = [](double x) { return placed({{x, 0, 0}}); };
  scene.plants.push_back(plant_entry("a", little_plant(), 0, {at(0), at(10)}));
  scene.plants.push_back(plant_entry("b", little_plant(), 0, {at(20)}));
  scene.groups.resize(2);
  scene.groups[0].name = "stand";
  scene.groups[0].members = {{true, 1, at(100)}, {true, 1, at(200)}, {false, 1, at(300)}};
  scene.groups[0].placements = {at(1000)};
  scene.groups[1].name = "tile";
  scene.groups[1].members = {{false, 0, at(1)}, {false, 1, at(2)}, {false, 0, at(3)}};
  scene.groups[1].placements = {at(5000)};
  scene.ground = flat_ground({2, 1}, {0, 0}, {2, 1}, {0.2});
  check_scene(scene);
  const FacetScene facets = expand(scene);
  const std::vector<std::string> paths{"a[0]",
                                       "a[1]",
                                       "b[0]",
                                       "stand[0]/tile[0]/a[0]",
                                       "stand[0]/tile[0]/b[0]",
                                       "stand[0]/tile[0]/a[1]",
                                       "stand[0]/tile[1]/a[0]",
                                       "stand[0]/tile[1]/b[0]",
                                       "stand[0]/tile[1]/a[1]",
                                       "stand[0]/b[0]",
                                       "tile[0]/a[0]",
                                       "tile[0]/b[0]",
                                       "tile[0]/a[1]",
                                       "ground"};
  CHECK(facets.organs.placements == paths);
  const std::vector<double> x{0, 10, 20, 1101, 1102, 1103, 1201, 1202, 1203, 1300, 5001, 5002, 5003};
  REQUIRE(facets.plant_facets == 3 * x.size());
  for (std::size_t copy = 0; copy < x.size(); ++copy) {
    CHECK(facets.corners[3 * copy][0].x == x[copy]);
    CHECK(facets.copies[copy].translation.x == x[copy]);
    CHECK(facets.shapes[2 * copy].first_facet == 3 * copy);
    CHECK(facets.shapes[2 * copy + 1].copy == copy);
    CHECK(facets.organs.placement[facets.organ[3 * copy]] == copy);
  }
  CHECK(facets.copy_plant == std::vector<std::uint32_t>{0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 0, 1, 0});
  CHECK(facets.organs.plants == std::vector<std::string>{"a", "b", "ground"});
  CHECK(facets.organs.types == std::vector<std::string>{"leaf", "ground"});
}

TEST_CASE("Ground cells are rows along x from the lowest x and y, fronts upwards", "[scene][expand]") {
  Scene scene = little_scene();
  scene.ground = flat_ground({4, 6}, {10, 20}, {2, 3}, {0.2});
  scene.ground->height = 0.5;
  const FacetScene facets = expand(scene);
  REQUIRE(facets.size() == 12);
  CHECK(facets.plant_facets == 0);
  CHECK(facets.corners[0] == Triangle{Vec3{8, 17, 0.5}, Vec3{10, 17, 0.5}, Vec3{10, 19, 0.5}});
  CHECK(facets.corners[1] == Triangle{Vec3{8, 17, 0.5}, Vec3{10, 19, 0.5}, Vec3{8, 19, 0.5}});
  CHECK(facets.corners[2][0] == Vec3{10, 17, 0.5});  // the next cell along x
  CHECK(facets.corners[4][0] == Vec3{8, 19, 0.5});   // the next row
  for (std::size_t f = 0; f < 12; ++f) {
    CHECK(area_vector(facets.corners[f]) == Vec3{0, 0, 2});
    CHECK(facets.organ[f] == f / 2);
    CHECK(facets.optics[f] == 1);
  }
  CHECK(facets.materials[1].reflectance_front == std::vector<float>{0.2f});
  CHECK(facets.organs.names[facets.organs.name[5]] == "cell_1_2");
}

TEST_CASE("Facets without area stay as rows and are counted", "[scene][expand]") {
  Scene scene = little_scene();
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {50, 50, 50}}, {{0, 1, 2}, {0, 1, 1}, {3, 3, 3}}};
  scene.plants.push_back(plant_entry("p", make_plant(mesh), 0, {placed({})}));
  const FacetScene facets = expand(scene);
  CHECK(facets.size() == 3);
  CHECK(facets.zero_area_facets == 2);
  CHECK(facets.area == std::vector<float>{0.5f, 0.0f, 0.0f});
  CHECK(facets.bounds.high == Vec3{1, 1, 0});
}

TEST_CASE("A scene too large or empty is refused before memory is taken", "[scene][expand]") {
  Scene scene = little_scene();
  CHECK_THROWS_WITH(expand(scene), "scene in memory: found no facet; expected at least one plant placed in the world, or a ground");
  scene.plants.push_back(plant_entry("p", little_plant(), 0, {}));
  for (std::uint32_t g = 0; g < 70; ++g) {  // each holds the next twice: 2^70 copies
    GroupEntry group;
    group.name = "g" + std::to_string(g);
    const bool last = g == 69;
    for (int i = 0; i < 2; ++i) group.members.push_back({!last, last ? 0 : g + 1, placed({})});
    scene.groups.push_back(group);
  }
  scene.groups[0].placements = {placed({})};
  check_scene(scene);
  CHECK_THROWS_WITH(expand(scene), "scene in memory: found more than 2^31 facets; expected fewer copies, or smaller plants");
}
