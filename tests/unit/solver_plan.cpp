#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>

#include <sunfleck/solver/plan.hpp>

using namespace sunfleck;

namespace {

/// One horizontal triangle, black but for what a test sets, under a sun.
Scene one_triangle() {
  auto plant = std::make_shared<Plant>();
  plant->structures.resize(1);
  plant->type_index("leaf");
  plant->material_index("");
  plant->meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  Shape shape;
  shape.triangle_count = 1;
  plant->shapes = {shape};
  Scene scene;
  scene.bands = {"PAR", "NIR"};
  scene.optics = {{"leaf", {0, 0}, {0, 0}, {0, 0}}};
  scene.plants = {{"leaf", plant, {0}, "", {{Affine{}}}}};
  scene.states.resize(1);
  scene.states[0].sun = Sun{{0, 0, 1}, {400, 400}, 0.0};
  return scene;
}

const PlanItem& item(const Plan& plan, const std::string& name) {
  const auto found = std::find_if(plan.items.begin(), plan.items.end(), [&](const PlanItem& i) { return i.name == name; });
  REQUIRE(found != plan.items.end());
  return *found;
}

}  // namespace

TEST_CASE("what a scene does not have is left out, with the reason", "[solver][plan]") {
  const Plan plan = make_plan(one_triangle(), {"clustering", Quality::standard}, {}, silent());
  for (const char* name :
       {"states", "sun disc", "sky", "lamps", "sensors", "periodicity", "ground", "copies", "scattering", "transmission"}) {
    INFO(name);
    CHECK_FALSE(item(plan, name).done);
    CHECK_FALSE(item(plan, name).why.empty());
  }
  for (const char* name : {"bands", "sun", "certificate"}) CHECK(item(plan, name).done);
  CHECK(item(plan, "scattering").why == "every surface is black in every band");
}

TEST_CASE("what a scene has is planned", "[solver][plan]") {
  Scene scene = one_triangle();
  scene.optics[0].transmittance[1] = 0.4f;
  scene.states[0].sun->angular_diameter_deg = 0.53;
  scene.states.push_back(scene.states[0]);
  scene.states[1].sun.reset();
  scene.states[1].sky = Sky{};
  scene.periodic = PeriodicCell{0, 0, 2, 1};
  scene.plants[0].placements.push_back({Affine::translate({1, 0, 0})});
  const Plan plan = make_plan(scene, {"clustering", Quality::standard}, {}, silent());
  for (const char* name : {"states", "sun disc", "sky", "periodicity", "copies", "scattering", "transmission"}) {
    INFO(name);
    CHECK(item(plan, name).done);
  }
  CHECK(item(plan, "sun").why.find("in 1 of 2 states") != std::string::npos);
  CHECK(plan.counts.plant_facets == 2);
  CHECK(plan.memory_total() > 0);
}

TEST_CASE("a method leaves out what it does not do", "[solver][plan]") {
  Scene scene = one_triangle();
  scene.optics[0].transmittance[0] = 0.1f;
  CHECK(item(make_plan(scene, {"direct", Quality::standard}, {}, silent()), "scattering").why ==
        "method 'direct' stops at the light that arrives first");
  CHECK_FALSE(item(make_plan(scene, {"direct", Quality::standard}, {}, silent()), "transmission").done);
  CHECK_FALSE(item(make_plan(scene, {"reference", Quality::standard}, {}, silent()), "certificate").done);
}

TEST_CASE("a scene with lamps or sensors is not left to instantiation, which knows neither", "[solver][plan][lamps][sensors]") {
  Scene scene = one_triangle();
  scene.sensors.push_back({"grid", SensorGrid{1.0, {1, 1}, {}, {}}, false, 0});
  const auto with_sensor = default_method(scene, Quality::draft, silent());
  CHECK(with_sensor.method == "clustering");
  CHECK(with_sensor.why == "instantiation knows no sensors");
  scene.lamps.emplace_back();
  const auto with_lamp = default_method(scene, Quality::draft, silent());
  CHECK(with_lamp.method == "clustering");
  CHECK(with_lamp.why == "instantiation knows no lamps");
  // nor planned with it
  CHECK_THROWS_WITH(
      make_plan(scene, {"instantiation", Quality::draft}, {}, silent()),
      "scene in memory: lamp: found a lamp with method 'instantiation'; expected clustering, flat, direct or reference, which know "
      "lamps and sensors");
}
