// A scene built through the library, without any file: also the example of how to.
#include <catch2/catch.hpp>

#include <limits>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/sky.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

/// A row of three small plants above soil that repeats without end, under sun and overcast sky, in two bands.
Scene row_of_plants() {
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.band_units = {"W m^-2", "W m^-2"};
  scene.periodic = PeriodicCell{0, 0, 3, 1};

  LightState morning;
  morning.name = "morning";
  morning.duration_s = 3600;
  morning.sun = Sun{direction_from_angles(40.0, 120.0), {300.0, 330.0}};
  morning.sky.emplace();
  morning.sky->model = SkyModel::standard_overcast;
  morning.sky->irradiance = {80.0, 60.0};
  prepare_sky(*morning.sky, "morning");
  scene.states = {morning};

  scene.optics = {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})};
  scene.ground = flat_ground({3, 1}, {1.5, 0.5}, {6, 2}, {0.12, 0.20});

  Mesh leaf{{{0, 0, 0.3}, {0.2, 0, 0.4}, {0.2, 0.1, 0.4}, {0, 0.1, 0.3}}, {{0, 1, 2}, {0, 2, 3}}};
  std::vector<Placement> places;
  for (int i = 0; i < 3; ++i) places.push_back(placed({{0.5 + i, 0.5, 0.0}, 120.0 * i}));
  scene.plants = {plant_entry("seedling", make_plant(leaf, "seedling", "leaf"), 0, places)};
  return scene;
}

std::string refusal(const Scene& scene) {
  try {
    check_scene(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("A scene in memory is checked and written out like one from a file", "[scene][memory]") {
  const Scene scene = row_of_plants();
  check_scene(scene);
  const FacetScene facets = expand(scene);
  CHECK(facets.plant_facets == 6);
  CHECK(facets.size() == 6 + 24);
  CHECK(facets.organs.placements == std::vector<std::string>{"seedling[0]", "seedling[1]", "seedling[2]", "ground"});
}

TEST_CASE("What is wrong with a scene in memory is said at the door", "[scene][memory][hostile]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = [](auto&& change) {
    Scene scene = row_of_plants();
    change(scene);
    return refusal(scene);
  };
  CHECK(broken([](Scene&) {}) == "");
  CHECK(broken([](Scene& s) { s.bands.clear(); }) == "scene in memory: bands: found none; expected at least one band");
  CHECK(broken([](Scene& s) { s.bands[1] = "PAR"; }) == "scene in memory: bands: found \"PAR\" twice; expected names, each once");
  CHECK(broken([](Scene& s) { s.band_units.pop_back(); }) == "scene in memory: band_units: found 1 units; expected one per band, 2");
  CHECK(broken([](Scene& s) { s.states.clear(); }) == "scene in memory: states: found none; expected at least one lighting state");
  CHECK(broken([](Scene& s) { s.states[0].sun->irradiance = {1.0}; }) ==
        "scene in memory: state[0].sun.irradiance: found 1 values; expected one per band, 2");
  CHECK(broken([&](Scene& s) { s.states[0].sun->irradiance[1] = nan; }) ==
        "scene in memory: state[0].sun.irradiance.NIR: found nan; expected a finite number of zero or more");
  CHECK(broken([](Scene& s) { s.states[0].sky->irradiance[0] = -1; }) ==
        "scene in memory: state[0].sky.irradiance.PAR: found -1; expected a finite number of zero or more");
  CHECK(broken([](Scene& s) {
          s.states[0].sun->direction = {0, 0, 2};
        }) == "scene in memory: state[0].sun.direction: found a vector of length 2; expected a unit vector");
  CHECK(broken([&](Scene& s) {
          s.states[0].sun->direction = {0, 0, nan};
        }) == "scene in memory: state[0].sun.direction: found a vector of length nan; expected a unit vector");
  CHECK(broken([](Scene& s) {
          s.states[0].sun->direction = {1, 0, 0};
        }) == "scene in memory: state[0].sun.direction: found a sun at or below the horizon; expected no sun, or one above the horizon");
  CHECK(broken([](Scene& s) { s.states[0].sun->angular_diameter_deg = -1; }) ==
        "scene in memory: state[0].sun.angular_diameter_deg: found -1; expected 0 to 90 degrees");
  CHECK(broken([](Scene& s) { s.states[0].sky->model = SkyModel::clear; }) ==
        "scene in memory: state[0].sky: found a clear sky without a sun; expected the direction of the sun, about which it is built");
  CHECK(broken([](Scene& s) { s.optics[0].reflectance_back[1] = 0.7f; }) ==
        "scene in memory: optics.leaf.NIR: found reflectance 0.7 + transmittance 0.4 = 1.1; expected a sum of at most 1");
  CHECK(broken([](Scene& s) { s.optics[0].transmittance.clear(); }) ==
        "scene in memory: optics.leaf.transmittance: found 0 values; expected one per band, 2");
  CHECK(broken([](Scene& s) { s.optics[0].reflectance_front[0] = -0.1f; }) ==
        "scene in memory: optics.leaf.reflectance_front.PAR: found -0.1; expected a number from 0 to 1");
  CHECK(broken([](Scene& s) { s.periodic->x_high = 0; }) ==
        "scene in memory: domain.periodic: found a cell of 0 by 1 m; expected lengths above zero");
  CHECK(broken([](Scene& s) { s.periodic->x_high = 4; }) ==
        "scene in memory: ground: found ground from (0, 0) to (3, 1); expected ground that fills the periodic cell, (0, 0) to (4, 1)");
  CHECK(broken([](Scene& s) { s.ground->cells[0] = 0; }) ==
        "scene in memory: ground.cells: found 0; expected at least one cell along x and y");
  CHECK(broken([](Scene& s) { s.ground->optics.transmittance[0] = 0.1f; }) ==
        "scene in memory: ground.optics.transmittance: found 0.1; expected 0: ground lets nothing through");
  CHECK(broken([&](Scene& s) { s.ground->height = nan; }) ==
        "scene in memory: ground.height: found nan; expected coordinates from -1e+08 to 1e+08 m");
  CHECK(broken([](Scene& s) { s.plants[0].plant = nullptr; }) == "scene in memory: plant[0]: found no plant; expected a plant");
  CHECK(broken([](Scene& s) { s.plants[0].shape_optics[0] = 3; }) ==
        "scene in memory: plant[0].shape_optics: found row 3; expected a row of the scene's 1 optics");
  CHECK(broken([](Scene& s) { s.plants[0].shape_optics.clear(); }) ==
        "scene in memory: plant[0].shape_optics: found 0 rows; expected one per shape, 1");
  CHECK(broken([&](Scene& s) { s.plants[0].placements[1].map.translation.z = nan; }) ==
        "scene in memory: plant[0].place[1]: found a map that is not finite; expected finite numbers");
  CHECK(broken([](Scene& s) { s.plants[0].placements[2].map.linear[2] = Vec3{0.0}; }) ==
        "scene in memory: plant[0].place[2]: found a map that flattens the copy; expected one that can be inverted");
}

TEST_CASE("Groups in memory may not hold themselves or what is not there", "[scene][memory][hostile]") {
  Scene scene = row_of_plants();
  scene.groups.resize(3);
  scene.groups[0].name = "tile";
  scene.groups[1].name = "row";
  scene.groups[2].name = "stand";
  scene.groups[0].members = {{false, 0, placed({})}};
  CHECK(refusal(scene) == "scene in memory: group[1]: found no member; expected at least one plant or group");
  scene.groups[2].members = scene.groups[0].members;
  scene.groups[1].members = {{true, 0, placed({})}, {true, 2, placed({})}, {true, 0, placed({})}};
  CHECK(refusal(scene) == "");
  scene.groups[2].members = {{false, 0, placed({})}, {true, 1, placed({})}};
  CHECK(group_cycle(scene) == std::vector<std::uint32_t>{1, 2, 1});
  CHECK(refusal(scene) ==
        "scene in memory: group[1]: found a group that holds itself: \"row\" -> \"stand\" -> \"row\"; expected groups without a circle");
  scene.groups[2].members = {{true, 7, placed({})}};
  CHECK(refusal(scene) == "scene in memory: group[2].place[0]: found group number 7; expected a number below 3");

  // A chain too long to walk.
  scene.groups.assign(2000, scene.groups[0]);
  for (std::uint32_t g = 0; g + 1 < 2000; ++g) scene.groups[g].members = {{true, g + 1, placed({})}};
  CHECK(refusal(scene) == "scene in memory: group[0]: found more than 1000 groups inside each other; expected fewer levels");
}
