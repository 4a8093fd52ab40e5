// Pictures made while rows come by: the same as from all of the light, with the light of what is seen only.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/picture_sink.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

/// Irradiance that tells facets apart.
IrradianceRows made_up(std::size_t first, std::size_t count, std::vector<float>& irradiance, std::vector<float>& sunlit) {
  irradiance.resize(count * 4);
  sunlit.assign(count * 2, 0.5f);
  for (std::size_t i = 0; i < irradiance.size(); ++i) irradiance[i] = 50.0f + static_cast<float>((first * 4 + i) % 97);
  return {first, count, irradiance.data(), sunlit.data(), nullptr};
}

}  // namespace

TEST_CASE("picture sink: draws what draw_natural draws of all the light, and keeps what is seen") {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({3, 3}, {0.5, 0.5}, {20, 20}, {0.12, 0.2});
  add(scene, "crown", leaves(400, 0.12, {1, 1, 1}, 3), 0);
  scene.plants[0].placements = {{}, {Affine::translate({1.2, 0, 0})}};
  for (int i = 0; i < 150; ++i) scene.plants[0].placements.push_back({Affine::translate({2.0 * i, -300, 0})});  // behind the camera
  sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.5, 0.1, 0.8}), {400, 400}, 0.53};
  const auto placed = place(scene);
  PictureSettings settings;
  settings.width = 160, settings.height = 120, settings.samples = 4;
  settings.camera.eye = Vec3{0.5, -4, 2}, settings.camera.target = Vec3{0.5, 0.5, 0.4};
  KeptLight kept(1, placed.facets, 2);
  PictureSink sink(scene, placed, 0, settings, &kept, silent());
  CHECK(sink.kept() < placed.facets / 2);
  CHECK_THROWS_AS(sink.draw(silent()), Error);
  std::vector<float> irradiance, sunlit;
  for (std::size_t first = 0; first < placed.facets; first += 333)
    sink.rows(made_up(first, std::min<std::size_t>(333, placed.facets - first), irradiance, sunlit));
  CHECK(kept.complete());
  const Image drawn = sink.draw(silent()).image;

  const StateLight light{scene.bands, std::nullopt, kept.irradiance, kept.sunlit, scene.states[0].sun};
  const DrawnScene whole(scene, placed);
  const Image expected = draw_natural(whole, light_source(light, placed.facets), settings, silent()).image;
  double worst = 0;
  for (int y = 0; y < settings.height; ++y)
    for (int x = 0; x < settings.width; ++x)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(static_cast<double>(drawn.at(x, y)[c]) - expected.at(x, y)[c]));
  CHECK(worst <= 1);  // of 255: interpolation between facets looks at neighbours that are not seen, which were not kept
}
