// Pictures of results: the same however values are read and meshes are held; views, cuts, layers; and two golden pictures.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <tbb/global_control.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/stored.hpp>

#include "golden_picture.hpp"
#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

Result store(const Folder& folder) {
  const Scene scene = small_scene(12);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
  return Result(folder / "r.h5");
}

PictureSettings small() {
  PictureSettings s;
  s.width = 160, s.height = 120, s.samples = 9;
  s.camera.elevation_deg = 12, s.camera.azimuth_deg = 140;
  return s;
}

/// Near the largest copy.
PictureSettings close() {
  PictureSettings s = small();
  s.camera.eye = Vec3{6.5, -1.5, 1.3}, s.camera.target = Vec3{5.0, 0.1, 0.85};
  s.camera.field_of_view_deg = 48;
  return s;
}

bool same(const Image& a, const Image& b) {
  return a.width() == b.width() && a.height() == b.height() && std::equal(a.data(), a.data() + a.width() * a.height(), b.data());
}

MapSource absorbed(const Result& result, const DrawnScene& scene) {
  return stored_map(result, scene, {}, silent());
}

int different(const Image& a, const Image& b, int left, int right) {
  int n = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = left; x < right; ++x) n += a.at(x, y) != b.at(x, y);
  return n;
}

}  // namespace

TEST_CASE("a picture is the same with one thread and many, and whether values are read whole or where they are seen", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  const LightSource light = stored_light(result, scene, 0);
  const MapSource map = absorbed(result, scene);
  PictureSettings settings = small();
  const Image colour = draw_natural(scene, light, settings, silent()).image, mapped = draw_map(scene, map, settings, silent()).image;
  settings.most_value_bytes = 0;
  REQUIRE(same(colour, draw_natural(scene, light, settings, silent()).image));
  REQUIRE(same(mapped, draw_map(scene, map, settings, silent()).image));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  REQUIRE(same(colour, draw_natural(scene, light, settings, silent()).image));
}

TEST_CASE("a scene in memory and the same scene from its file look alike", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  const FacetScene flat = stored_scene(result);
  const Image a = draw_natural(scene, stored_light(result, scene, 0), small(), silent()).image,
              b = draw_natural(flat, stored_light(result, flat, 0), small(), silent());
  REQUIRE(different(a, b, 0, 160) < 160 * 120 / 100);  // the meshes are rounded about other points: rays past edges, rounding of colours
}

TEST_CASE("several views share a scale, and are named", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  PictureSettings settings = small();
  settings.width = 300;
  settings.views = {"front", "top"};
  settings.scale_bar = true;
  const Image two = draw_map(scene, absorbed(result, scene), settings, silent()).image;
  settings.scale_bar = false;
  const Image bare = draw_map(scene, absorbed(result, scene), settings, silent()).image;
  const int middle = static_cast<int>(0.83 * 300) / 2;
  REQUIRE(different(two, bare, 0, middle) > 20);  // a bar in each
  REQUIRE(different(two, bare, middle, 2 * middle) > 20);
  REQUIRE(different(two, bare, 260, 300) == 0);  // none on the legend
  settings.views = {"fornt"};
  REQUIRE_THROWS_WITH(draw_map(scene, absorbed(result, scene), settings, silent()),
                      "--views: found 'fornt'; expected some of camera, front, back, left, right, top, bottom (did you mean 'front'?)");
  settings.views = {};
  settings.scale_bar = true;
  REQUIRE_THROWS_WITH(draw_map(scene, absorbed(result, scene), settings, silent()),
                      Catch::Matchers::StartsWith("--scale-bar: found no parallel projection"));
}

TEST_CASE("a cut takes plants away on one side of it, and no ground", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  PictureSettings settings = small();
  settings.layers = true;
  const auto seen = [&](std::optional<PictureCut> cut) {
    settings.cut = cut;
    const Picture picture = draw_map(scene, absorbed(result, scene), settings, silent());
    REQUIRE(picture.layers);
    Box plants;
    int ground = 0;
    for (const auto f : picture.layers->facet) {
      if (f == no_row) continue;
      if (f >= scene.plant_facets()) {
        ++ground;
        continue;
      }
      for (const auto& p : scene.corners(scene.place(f))) plants.add(p);
    }
    return std::pair{plants, ground};
  };
  const auto [all, ground] = seen(std::nullopt);
  REQUIRE(all.high.x > 4);
  // Longest leaf of the largest copy: 1.7 x 0.22 m may reach over the plane.
  const auto [west, more] = seen(PictureCut{{2, 0, 0}, {1, 0, 0}});
  REQUIRE(west.high.x < 2.4);
  REQUIRE(more >= ground);
  const auto [east, other] = seen(PictureCut{{2, 0, 0}, {-1, 0, 0}});
  REQUIRE(east.low.x > 1.6);
  REQUIRE(other >= ground);
  // The camera stands in the south-east: the same as the first.
  REQUIRE(seen(PictureCut{{2, 0, 0}, {-1, 0, 0}, true}).first.high.x < 2.4);
  REQUIRE_THROWS_AS(seen(PictureCut{{2, 0, 0}, {0, 0, 0}}), UsageError);
}

TEST_CASE("EXR files hold depth, organ, facet and the mapped quantity, as another reader sees them", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  PictureSettings settings = small();
  settings.layers = true;
  settings.camera.orthographic = true;
  const MapSource map = absorbed(result, scene);
  const auto layers = *draw_map(scene, map, settings, silent()).layers;
  write_exr(layers, folder / "p.exr");
  REQUIRE(folder.files() == 2);

  Imf::InputFile in((folder / "p.exr").c_str());
  REQUIRE(in.header().channels().findChannel("R")->type == Imf::HALF);
  REQUIRE(in.header().channels().findChannel("organ.id")->type == Imf::UINT);
  const std::size_t n = 160 * 120;
  std::vector<float> depth(n), value(n), alpha(n);
  std::vector<std::uint32_t> organ(n), facet(n);
  Imf::FrameBuffer buffer;
  const auto add = [&](const char* name, Imf::PixelType type, void* data) {
    buffer.insert(name, Imf::Slice(type, static_cast<char*>(data), 4, 4 * 160));
  };
  add("Z", Imf::FLOAT, depth.data()), add("value", Imf::FLOAT, value.data()), add("A", Imf::FLOAT, alpha.data());
  add("organ.id", Imf::UINT, organ.data()), add("facet.id", Imf::UINT, facet.data());
  in.setFrameBuffer(buffer);
  in.readPixels(0, 119);

  const auto stored = result.state_rows<float>("facets/absorbed", 0, 0, scene.size());
  const Camera camera(settings.camera, scene.outline(), 160.0 / 120.0, {.right = 0.80});
  int met = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (facet[i] == no_row) {
      REQUIRE(std::isinf(depth[i]));
      REQUIRE(organ[i] == no_row);
      continue;
    }
    ++met;
    REQUIRE(organ[i] == scene.organ(scene.place(facet[i])));
    REQUIRE(alpha[i] > 0);
    if (facet[i] < scene.plant_facets())
      REQUIRE(value[i] == stored[2 * facet[i]]);
    else
      REQUIRE(std::isnan(value[i]));
    // The depth lies between those of the facet's corners.
    double low = 1e300, high = -1e300;
    for (const auto& p : scene.corners(scene.place(facet[i]))) {
      const double d = glm::dot(p - camera.eye(), camera.forward());
      low = std::min(low, d), high = std::max(high, d);
    }
    REQUIRE(depth[i] > low - 1e-4);  // single precision of some ten metres
    REQUIRE(depth[i] < high + 1e-4);
  }
  REQUIRE(met > 500);
  REQUIRE_THROWS_WITH(write_exr(layers, folder / "p.png"), Catch::Matchers::EndsWith("found the suffix '.png'; expected .exr"));
  REQUIRE_THROWS_AS(write_exr(layers, folder / "none/p.exr"), OutputError);
}

TEST_CASE("golden pictures: natural colour, and a map", "[view]") {
  const Folder folder;
  const Result result = store(folder);
  const DrawnScene scene(result);
  check_golden(draw_natural(scene, stored_light(result, scene, 0), close(), silent()).image, "golden_colour.png", 160);
  // Left of the legend, whose text depends on the fonts of the machine.
  check_golden(draw_map(scene, absorbed(result, scene), close(), silent()).image, "golden_map.png", 132);
}
