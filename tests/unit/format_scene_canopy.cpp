#include <catch2/catch.hpp>

#include <scene_files.hpp>
#include <sunfleck/scene/facets.hpp>

using namespace sunfleck;

namespace {

const std::string canopy = R"(bands = ["PAR", "NIR"]

[domain]
periodic = [0.0, 0.0, 1.0, 1.0]

[sun]
direction = [0.0, 0.0, 1.0]
irradiance = { PAR = 400.0, NIR = 450.0 }
angular_diameter = 0.0

[optics.leaf]
reflectance = { PAR = 0.10, NIR = 0.45 }
transmittance = { PAR = 0.05, NIR = 0.40 }

[ground]
size = [1.0, 1.0]
center = [0.5, 0.5]
cells = [20, 20]
height = 0.0
reflectance = { PAR = 0.15, NIR = 0.20 }

[[plant]]
name = "canopy"
file = "canopy.obj"
optics = { "*" = "leaf" }
place = [ { position = [0, 0, 0] } ]
)";

}  // namespace

TEST_CASE("A canopy scene is read with all its parts", "[format][scene]") {
  const SceneFiles files(canopy, {{"canopy.obj", two_organs}});
  const Scene scene = files.read();
  CHECK(scene.text == canopy);
  CHECK(scene.bands == std::vector<std::string>{"PAR", "NIR"});
  CHECK(scene.band_units == std::vector<std::string>{"W m^-2", "W m^-2"});
  REQUIRE(scene.periodic);
  CHECK(scene.periodic->area() == 1.0);
  REQUIRE(scene.states.size() == 1);
  REQUIRE(scene.states[0].sun);
  CHECK(scene.states[0].sun->direction == Vec3{0, 0, 1});
  CHECK(scene.states[0].sun->irradiance == std::vector<double>{400, 450});
  CHECK(scene.states[0].sun->angular_diameter_deg == 0.0);
  CHECK_FALSE(scene.states[0].sky);
  REQUIRE(scene.optics.size() == 1);
  CHECK(scene.optics[0].name == "leaf");
  CHECK(scene.optics[0].reflectance_front == std::vector<float>{0.10f, 0.45f});
  CHECK(scene.optics[0].reflectance_back == scene.optics[0].reflectance_front);
  CHECK(scene.optics[0].transmittance == std::vector<float>{0.05f, 0.40f});
  REQUIRE(scene.ground);
  CHECK(scene.ground->cells == std::array<std::uint32_t, 2>{20, 20});
  CHECK(scene.ground->optics.reflectance_front == std::vector<float>{0.15f, 0.20f});
  REQUIRE(scene.plants.size() == 1);
  CHECK(scene.plants[0].placements.size() == 1);
  CHECK(scene.notes.empty());

  const FacetScene facets = expand(scene);
  CHECK(facets.plant_facets == 4);
  CHECK(facets.size() == 4 + 800);
  CHECK(facets.materials.size() == 2);
  CHECK(facets.organs.size() == 2 + 400);
}
