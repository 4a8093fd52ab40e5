#include <catch2/catch.hpp>

#include <algorithm>

#include <sunfleck/view/colour.hpp>

using namespace sunfleck;

TEST_CASE("sRGB codes survive decoding and encoding", "[view]") {
  for (int v = 0; v < 256; ++v) {
    const auto code = static_cast<std::uint8_t>(v);
    REQUIRE(encode_srgb(decode_srgb({code, code, code})) == Rgb8{code, code, code});
  }
  REQUIRE(encode_srgb({-1.0f, 2.0f, 0.0f}) == Rgb8{0, 255, 0});
}

TEST_CASE("colour bands: red, green and blue by name, else PAR, else the first", "[view]") {
  const std::vector<std::string> named{"NIR", "Blue", "green", "R"}, par{"NIR", "PAR"}, other{"NIR", "SWIR"};
  REQUIRE(colour_bands(named).measured);
  REQUIRE(colour_bands(named).rgb == std::array<std::size_t, 3>{3, 2, 1});
  REQUIRE_FALSE(colour_bands(par).measured);
  REQUIRE(colour_bands(par).rgb[0] == 1);
  REQUIRE(colour_bands(other).rgb[0] == 0);
}

TEST_CASE("surfaces are guessed from optics first, then from the organ's type", "[view]") {
  REQUIRE(surface_of("Metamer", "leaf") == SurfaceKind::leaf);
  REQUIRE(surface_of("Metamer", "a") == SurfaceKind::bark);
  REQUIRE(surface_of("ground", "ground") == SurfaceKind::soil);
  REQUIRE(surface_of("", "linear") == SurfaceKind::leaf);
  REQUIRE(surface_of("ear_2", "x") == SurfaceKind::ear);
  REQUIRE(surface_of("stem", "wheat") == SurfaceKind::stem);
  REQUIRE(surface_of("stem", "bark") == SurfaceKind::bark);
  REQUIRE(surface_of("organ", "wall") == SurfaceKind::made);
  REQUIRE(surface_of("pot_3", "x") == SurfaceKind::made);
  REQUIRE(surface_of("leaf", "white leaf") == SurfaceKind::leaf);
}

TEST_CASE("facet colour is the light that leaves the side", "[view]") {
  const Optics optics{"leaf", {0.1f, 0.4f, 0.2f}, {0.2f, 0.5f, 0.3f}, {0.05f, 0.3f, 0.1f}};
  const float irradiance[] = {100, 200, 300, 10, 20, 30};
  const ColourBands bands{{2, 1, 0}, true};
  // Float arithmetic of a few operations: 1e-5 relative.
  const Rgb front = facet_colour(bands, optics, SurfaceKind::leaf, irradiance, Side::front);
  REQUIRE(front.r == Approx(0.2 * 300 + 0.1 * 30).epsilon(1e-5));
  REQUIRE(front.g == Approx(0.4 * 200 + 0.3 * 20).epsilon(1e-5));
  REQUIRE(front.b == Approx(0.1 * 100 + 0.05 * 10).epsilon(1e-5));
  const Rgb back = facet_colour(bands, optics, SurfaceKind::leaf, irradiance, Side::back);
  REQUIRE(back.b == Approx(0.2 * 10 + 0.05 * 100).epsilon(1e-5));
}

TEST_CASE("a guessed hue keeps the band's power: the channels' mean is the exitance", "[view]") {
  const Optics optics{"x", {0.1f}, {0.2f}, {0.05f}};
  const float irradiance[] = {100, 10};
  for (const auto surface : {SurfaceKind::leaf, SurfaceKind::stem, SurfaceKind::bark, SurfaceKind::ear, SurfaceKind::flower,
                             SurfaceKind::soil, SurfaceKind::made}) {
    const Rgb c = facet_colour({}, optics, surface, irradiance, Side::front);
    REQUIRE((c.r + c.g + c.b) / 3 == Approx(0.1 * 100 + 0.05 * 10).epsilon(1e-5));  // tints are written with two decimals, mean exactly 1
  }
  const Rgb leaf = facet_colour({}, optics, SurfaceKind::leaf, irradiance, Side::front);
  REQUIRE(leaf.g > leaf.r);
  REQUIRE(leaf.r > leaf.b);
}

TEST_CASE("tone mapping rises with luminance, stays in range and keeps black", "[view]") {
  const Exposure exposure = exposure_for({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  REQUIRE(exposure.scale > 0.0f);
  REQUIRE(tone_map(Rgb{0.0f}, exposure) == Rgb{0.0f});
  float before = -1.0f;
  for (float l = 0.01f; l < 1e4f; l *= 1.5f) {
    const Rgb c = tone_map({0.3f * l, 1.2f * l, 0.1f * l}, exposure);
    REQUIRE(std::max({c.r, c.g, c.b}) <= 1.0001f);  // one rounding of the fade to white
    REQUIRE(luminance(c) >= before - 1e-6f);
    before = luminance(c);
  }
  REQUIRE(exposure_for({0, 0}).scale == 1.0f);
}
