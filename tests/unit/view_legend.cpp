#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <set>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/legend.hpp>

using namespace sunfleck;

namespace {

std::string labels(const ValueScale& scale, int wanted = 6) {
  std::string out;
  for (const auto& tick : nice_ticks(scale, wanted)) out += (out.empty() ? "" : " ") + tick.label;
  return out;
}

bool near(const Rgb8& a, const Rgb8& b, int codes) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(int{a[c]} - int{b[c]}) > codes) return false;
  return true;
}

int inked(const Image& image) {
  int n = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) n += image.at(x, y) != Rgb8{255, 255, 255};
  return n;
}

}  // namespace

TEST_CASE("colour maps: ends and middle of the published tables, rising lightness", "[view]") {
  // Published first, middle and last entries; the fits' largest error is given in colormap.hpp.
  REQUIRE(near(color_at(ColorMap::viridis, 0), {68, 1, 84}, 2));
  REQUIRE(near(color_at(ColorMap::viridis, 0.5), {33, 145, 140}, 2));
  REQUIRE(near(color_at(ColorMap::viridis, 1), {253, 231, 37}, 2));
  REQUIRE(near(color_at(ColorMap::magma, 1), {252, 253, 191}, 3));
  REQUIRE(near(color_at(ColorMap::inferno, 1), {252, 255, 164}, 4));
  REQUIRE(near(color_at(ColorMap::cividis, 0), {0, 32, 77}, 7));
  for (const auto& name : color_map_names()) {
    if (name == "difference") continue;
    float before = -1;
    for (int i = 0; i <= 64; ++i) {
      const float l = luminance(decode_srgb(color_at(color_map_from_name(name), i / 64.0)));
      REQUIRE(l > before - 1e-3f);  // one code of rounding in a dark channel
      before = l;
    }
  }
  REQUIRE(color_at(ColorMap::viridis, -3) == color_at(ColorMap::viridis, 0));
  REQUIRE(color_at(ColorMap::viridis, std::numeric_limits<double>::quiet_NaN()) == Rgb8{128, 128, 128});
  REQUIRE_THROWS_WITH(
      color_map_from_name("virdis"),
      "--colormap: found 'virdis'; expected one of viridis, magma, inferno, cividis, grey, difference (did you mean 'viridis'?)");
  std::set<Rgb8> distinct;
  for (std::size_t k = 0; k < 60; ++k) distinct.insert(category_color(k));
  REQUIRE(distinct.size() == 60);
}

TEST_CASE("the colour map for differences is white at zero, blue below, red above, and darkens by equal steps of lightness", "[view]") {
  // OKLab lightness of a display colour (Ottosson 2020).
  const auto lightness = [](const Rgb8& colour) {
    const Rgb c = decode_srgb(colour);
    return 0.2104542553 * std::cbrt(0.4122214708 * c.r + 0.5363325363 * c.g + 0.0514459929 * c.b) +
           0.7936177850 * std::cbrt(0.2119034982 * c.r + 0.6806995451 * c.g + 0.1073969566 * c.b) -
           0.0040720468 * std::cbrt(0.0883024619 * c.r + 0.2817188376 * c.g + 0.6299787005 * c.b);
  };
  const auto at = [](double t) { return color_at(ColorMap::difference, t); };
  REQUIRE(std::min({at(0.5)[0], at(0.5)[1], at(0.5)[2]}) > 240);
  REQUIRE(at(0)[2] > at(0)[0] + 100);
  REQUIRE(at(1)[0] > at(1)[2] + 100);
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.05 * i, expected = 0.97 - 0.5 * (1 - 2 * t);
    REQUIRE(lightness(at(t)) == Approx(expected).margin(0.005));  // rounding to 8 bits; no channel is clamped
    REQUIRE(lightness(at(1 - t)) == Approx(expected).margin(0.005));
  }
}

TEST_CASE("ticks are round numbers inside the range", "[view]") {
  REQUIRE(labels({0, 100}) == "0 20 40 60 80 100");
  REQUIRE(labels({0, 0.95}) == "0.0 0.2 0.4 0.6 0.8");
  REQUIRE(labels({-3, 4}) == "-3 -2 -1 0 1 2 3 4");
  REQUIRE(labels({312, 357}) == "320 330 340 350");
  REQUIRE(labels({0, 3e6}) == "0 500000 1e+06 1.5e+06 2e+06 2.5e+06 3e+06");
  REQUIRE(labels({0.1, 100, true}) == "0.1 1 10 100");
  REQUIRE(labels({3, 70, true}) == "5 10 20 50");
  REQUIRE(labels({3, 9, true}) == "3 4 5 6 7 8 9");
}

TEST_CASE("a scale is taken from percentiles of the finite values", "[view]") {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(i);
  values.push_back(std::numeric_limits<double>::infinity());
  const auto linear = scale_for(values, false);
  REQUIRE(linear.low == 0);
  REQUIRE(linear.high == 990);
  REQUIRE(linear.position(495) == Approx(0.5));
  const auto log = scale_for(values, true);
  REQUIRE(log.low > 0);
  REQUIRE(log.position(log.high) == Approx(1));
  REQUIRE(std::isinf(log.position(0)));
  const auto same = scale_for({5, 5, 5}, false);
  REQUIRE(same.low < 5);
  REQUIRE(same.high > 5);
  REQUIRE(scale_for({0, 0}, false).high == 1);
  REQUIRE(scale_for({}, true).high == 1);
  REQUIRE(scale_for({800, 900, 1000}, false).low > 0);
}

TEST_CASE("text has a width, lands where it is aligned, and has a second choice of font", "[view]") {
  const Font best, plain = Font::plain();
  REQUIRE_FALSE(plain.outlines());
  for (const Font* font : {&best, &plain}) {
    REQUIRE(font->width("absorbed", 20) > 30);
    REQUIRE(font->width("absorbed", 40) == Approx(2 * font->width("absorbed", 20)).epsilon(1e-6));  // outlines scale in float
    Image left(200, 40), right(200, 40);
    font->draw(left, 100, 25, "W m⁻²", 20, {0, 0, 0});
    font->draw(right, 100, 25, "W m⁻²", 20, {0, 0, 0}, Align::right);
    REQUIRE(inked(left) > 40);
    for (int y = 0; y < 40; ++y) REQUIRE(left.at(90, y) == Rgb8{255, 255, 255});
    for (int y = 0; y < 40; ++y) REQUIRE(right.at(110, y) == Rgb8{255, 255, 255});
    Image outside(10, 10);
    font->draw(outside, -500, 500, "gone \xff\xc3", 20, {0, 0, 0});
    REQUIRE(inked(outside) == 0);
  }
  REQUIRE(pretty_unit("umol m^-2 s^-1") == "µmol m⁻² s⁻¹");
}

TEST_CASE("legends draw bar, ticks and names inside their place", "[view]") {
  const Font font;
  Image bar(200, 400), list(200, 400);
  const LegendPlace place{20, 20, 160, 360, 16};
  draw_bar(bar, font, place, {"absorbed", "W m⁻²"}, ColorMap::viridis, {0, 100}, true, true);
  draw_list(list, font, place, {"type"}, std::vector<std::string>(100, "leaf"), std::vector<Rgb8>(100, {0, 158, 115}));
  for (const Image* image : {&bar, &list}) {
    REQUIRE(inked(*image) > 1000);
    for (int y = 0; y < 400; ++y) REQUIRE(image->at(10, y) == Rgb8{255, 255, 255});
    for (int x = 0; x < 200; ++x) REQUIRE(image->at(x, 395) == Rgb8{255, 255, 255});
  }
}
