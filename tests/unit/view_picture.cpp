#include <catch2/catch.hpp>

#include <algorithm>

#include <tbb/global_control.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/view/picture.hpp>

using namespace sunfleck;

namespace {

/// A square leaf 1 m above the middle of a ground of 20 x 20 cells, 4 m wide.
FacetScene leaf_over_ground(std::optional<PeriodicCell> periodic = std::nullopt) {
  Plant plant;
  plant.name = "plate";
  const auto type = plant.type_index("Leaf");
  plant.materials = {""};
  plant.structures.push_back({no_parent, type, "leaf", {}, {}});
  plant.meshes.push_back({{{-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1}}, {{0, 1, 2}, {0, 2, 3}}});
  plant.shapes.push_back({0, 0, 0, 2, 0, {}});
  Scene scene;
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.states.emplace_back();
  scene.optics = {uniform_optics("leaf", {0.1}, {0.05})};
  scene.ground = flat_ground({4, 4}, {0, 0}, {20, 20}, {0.2});
  scene.plants.push_back(plant_entry("plate", plant, 0, {Placement{}}));
  scene.periodic = periodic;
  return expand(scene);
}

/// Sun straight above, 400 W m^-2, and an even 50 W m^-2 on both sides of everything; the leaf's shadow is in the stored fractions.
StateLight noon(const FacetScene& scene) {
  StateLight light;
  light.bands = {"PAR"};
  light.sun = Sun{{0, 0, 1}, {400}, 0.0};
  for (std::size_t f = 0; f < scene.size(); ++f) {
    const auto& c = scene.corners[f];
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
    const bool shaded = f >= scene.plant_facets && std::max(std::fabs(middle.x), std::fabs(middle.y)) < 0.5;
    light.sunlit.insert(light.sunlit.end(), {shaded ? 0.0f : 1.0f, 0.0f});
    light.irradiance.insert(light.irradiance.end(), {shaded ? 50.0f : 450.0f, 50.0f});
  }
  return light;
}

PictureSettings small(double elevation) {
  PictureSettings s;
  s.width = 96, s.height = 72, s.samples = 4;
  s.camera.elevation_deg = elevation;
  s.camera.target = Vec3{0, 0, 0.5};
  return s;
}

bool same(const Image& a, const Image& b) {
  return a.width() == b.width() && a.height() == b.height() && std::equal(a.data(), a.data() + a.width() * a.height(), b.data());
}

struct Impatient : Progress {
  bool cancelled() const override { return true; }
};

}  // namespace

TEST_CASE("a natural picture shows leaf, lit ground and shadow, the same with one thread and many", "[view]") {
  const FacetScene scene = leaf_over_ground();
  const StateLight light = noon(scene);
  PictureSettings settings = small(20);
  settings.camera.eye = Vec3{0, -6, 2};
  const Image picture = draw_natural(scene, light, settings, silent());
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    REQUIRE(same(picture, draw_natural(scene, light, settings, silent())));
  }
  const Camera camera(settings.camera, {}, 96.0 / 72.0);
  const auto pixel = [&](const Vec3& p) {
    const auto at = camera.project(p);
    REQUIRE(at);
    REQUIRE(std::clamp((*at)[1], 0.0, 0.999) == (*at)[1]);
    return picture.at(static_cast<int>((*at)[0] * 96), static_cast<int>((*at)[1] * 72));
  };
  const Rgb8 green = pixel({0, 0, 1}), shadow = pixel({0, 0, 0}), soil = pixel({0, -0.9, 0});
  REQUIRE(green[1] > green[0]);
  REQUIRE(green[0] > green[2]);
  REQUIRE(soil[0] > soil[2]);
  REQUIRE(luminance(decode_srgb(soil)) > 3 * luminance(decode_srgb(shadow)));  // 450 against 50 W m^-2, compressed by the tone curve
}

TEST_CASE("the beam drawn at a point has the stored mean: an evenly lit leaf looks the same with and without it", "[view]") {
  const FacetScene scene = leaf_over_ground();
  StateLight light = noon(scene);
  PictureSettings settings = small(90);
  settings.camera.azimuth_deg = 180;
  settings.camera.target.reset();
  const Image sharp = draw_natural(scene, light, settings, silent());
  light.sunlit.clear();  // stored irradiance alone, with no knowledge of the sun
  const Image stored = draw_natural(scene, light, settings, silent());
  // The leaf fills the picture from 5 to 95 % of its height: both ways must agree on it to a rounding of one code.
  for (int y = 6; y < 66; ++y)
    for (int x = 20; x < 76; ++x)
      for (std::size_t c = 0; c < 3; ++c) REQUIRE(std::abs(int{sharp.at(x, y)[c]} - int{stored.at(x, y)[c]}) <= 1);
}

TEST_CASE("a map shows the legend's exact colour of the side that is seen", "[view]") {
  const FacetScene scene = leaf_over_ground();
  FacetMap map;
  map.title = {"irradiance PAR", "W m^-2"};
  map.sides = true;
  for (std::size_t f = 0; f < scene.size(); ++f) map.values.insert(map.values.end(), {75.0f, 25.0f});
  map.scale = {0, 100, false};
  for (const double elevation : {80.0, -80.0}) {
    PictureSettings settings = small(elevation);
    settings.camera.target = Vec3{0, 0, 1};
    FacetScene plants = scene;
    if (elevation < 0) {  // seen from below the ground would hide the leaf
      plants.corners.resize(2), plants.area.resize(2), plants.optics.resize(2), plants.organ.resize(2);
    }
    FacetMap shown = map;
    shown.values.resize(2 * plants.size());
    REQUIRE(draw_map(plants, shown, settings, silent()).at(48, 36) == color_at(ColorMap::viridis, elevation > 0 ? 0.75 : 0.25));
  }
  map.values.pop_back();
  REQUIRE_THROWS_AS(draw_map(scene, map, small(80), silent()), Error);
}

TEST_CASE("a periodic scene is drawn as one cell or with its repetition", "[view]") {
  const FacetScene scene = leaf_over_ground(PeriodicCell{-2, -2, 2, 2});
  FacetMap map;
  map.values.assign(scene.size(), 1.0f);
  map.scale = {0, 2, false};
  PictureSettings settings = small(25);
  settings.map_ground = true;
  const auto coloured = [&](const Image& image) {
    int n = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 70; ++x) n += image.at(x, y) == color_at(ColorMap::viridis, 0.5);  // left of the legend
    return n;
  };
  settings.camera.orthographic = true;
  const int cell = coloured(draw_map(scene, map, settings, silent()));
  settings.infinite = true;
  const int all = coloured(draw_map(scene, map, settings, silent()));
  REQUIRE(cell > 0);
  REQUIRE(all >= cell);
  REQUIRE(all == 72 * 70);
}

TEST_CASE("pictures stop when asked, and refuse impossible settings", "[view]") {
  const FacetScene scene = leaf_over_ground();
  Impatient stop;
  REQUIRE_THROWS_AS(draw_natural(scene, noon(scene), small(20), stop), Stopped);
  PictureSettings none = small(20);
  none.samples = 0;
  REQUIRE_THROWS_WITH(draw_natural(scene, noon(scene), none, silent()), "--samples: found 0; expected 1 to 4096 per pixel");
}
