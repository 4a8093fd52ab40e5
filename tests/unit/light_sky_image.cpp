// Skies from pictures: closed forms of lobes, suns, and what is refused.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>
#include <sunfleck/light/open_light.hpp>
#include <sunfleck/light/sky_parts.hpp>
#include <sunfleck/light/sun.hpp>

using namespace sunfleck;

namespace {

using std::numbers::pi;

template <class Value>
Panorama picture(std::uint32_t columns, const Value& value, double turn = 0) {
  Panorama p;
  p.columns = columns;
  p.rows = columns / 2;
  p.turn_deg = turn;
  p.value.resize(std::size_t{p.columns} * p.rows);
  for (std::uint32_t row = 0; row < p.rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) p.at(row, column) = static_cast<float>(value(p, row, column));
  return p;
}

/// A lobe max(0, a . d) about an axis.
Panorama lobe(std::uint32_t columns, const Vec3& axis, double turn = 0) {
  return picture(
      columns,
      [&](const Panorama& p, std::uint32_t r, std::uint32_t c) { return std::max(0.0, glm::dot(axis, p.direction(r + 0.5, c + 0.5))); },
      turn);
}

Sky sky_of(Panorama p) {
  Sky sky;
  sky.model = SkyModel::image;
  sky.image = std::make_shared<const SkyImage>(std::move(p), "sky");
  prepare_sky(sky, "sky");
  return sky;
}

double horizontal_irradiance(const Sky& sky, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double z = (i + 0.5) / n, s = std::sqrt(1 - z * z), a = 2 * pi * (j + 0.5) / n;
      sum += z * sky.relative_radiance({s * std::cos(a), s * std::sin(a), z});
    }
  return sum * 2 * pi / (double(n) * n);
}

}  // namespace

TEST_CASE("A picture's middle looks to north, east lies to its right, and turn turns it to the east", "[light][sky]") {
  const auto north = picture(16, [](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 3 && (c == 7 || c == 8); });
  CHECK(sky_of(north).relative_radiance(direction_from_angles(90 - 180 * 3.5 / 8, 5)) > 0);
  CHECK(sky_of(north).relative_radiance(direction_from_angles(90 - 180 * 3.5 / 8, 90)) == 0);
  const auto east = picture(16, [](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 3 && (c == 11 || c == 12); });
  CHECK(sky_of(east).relative_radiance(direction_from_angles(90 - 180 * 3.5 / 8, 95)) > 0);
  auto turned = north;
  turned.turn_deg = 90;
  CHECK(sky_of(turned).relative_radiance(direction_from_angles(90 - 180 * 3.5 / 8, 95)) > 0);
  CHECK(sky_of(turned).relative_radiance(direction_from_angles(90 - 180 * 3.5 / 8, 5)) == 0);
}

TEST_CASE("A cosine lobe in a picture has its closed forms", "[light][sky]") {
  // radiance z: a horizontal plane gets 2 pi / 3, a vertical one 2 / 3
  const Sky up = sky_of(lobe(1024, {0, 0, 1}));
  CHECK(up.relative_radiance({0, 0, 1}) == Approx(3 / (2 * pi)).epsilon(1e-4));
  CHECK(up.relative_radiance({0.6, 0, 0.8}) == Approx(0.8 * 3 / (2 * pi)).epsilon(0.002));  // of pixels .35 degrees wide
  CHECK(horizontal_irradiance(up, 1000) == Approx(1.0).epsilon(0.001));
  const OpenSky open(up);
  CHECK(open.on({0, 0, 1}) == Approx(1.0).epsilon(1e-12));
  CHECK(open.on({1, 0, 0}) == Approx((2.0 / 3.0) / (2 * pi / 3)).epsilon(0.002));
  CHECK(open.on({0, 0, -1}) == 0.0);
  // a lobe about the east horizon: radiance max(0, x); horizontal irradiance 2/3, facing east integral x^2 over a quarter sphere = pi / 3
  const Sky east = sky_of(lobe(1024, {1, 0, 0}));
  CHECK(east.relative_radiance({0.8, 0, 0.6}) == Approx(0.8 / (2.0 / 3.0)).epsilon(0.004));
  CHECK(OpenSky(east).on({1, 0, 0}) == Approx((pi / 3) / (2.0 / 3.0)).epsilon(0.002));
  CHECK(OpenSky(east).on({-1, 0, 0}) == Approx(0.0).margin(1e-3));
  CHECK(OpenSky(sky_of(lobe(1024, {1, 0, 0}, 30))).on({1, 0, 0}) == Approx((pi / 3) / (2.0 / 3.0)).epsilon(0.002));
}

TEST_CASE("Pictures of any size bring irradiance 1 to a horizontal plane", "[light][sky]") {
  for (const std::uint32_t columns : {4u, 10u, 64u, 2048u, 3000u, 8192u}) {
    CAPTURE(columns);
    const Sky sky = sky_of(lobe(columns, glm::normalize(Vec3{0.3, -0.5, 0.6})));
    CHECK(horizontal_irradiance(sky, 1500) == Approx(1.0).epsilon(columns < 64 ? 0.002 : 5e-4));  // the midpoint rule at edges of pixels
    CHECK(sky.image->picture().columns <= SkyImage::most_columns);
    double light = 0, level = 0;
    each_part(sky, 100'000, [&](const Vec3&, double l, double w) { light += l, level += w; });
    CHECK(light == Approx(1.0).epsilon(1e-9));
    CHECK(level == Approx(pi).epsilon(1e-9));
  }
}

TEST_CASE("Shrinking a picture keeps its light where it is", "[light][sky]") {
  const auto fine = lobe(3000, glm::normalize(Vec3{0.3, -0.5, 0.6}));
  const OpenSky small(sky_of(shrunk(fine, 512))), all(sky_of(fine));
  for (const Vec3& n : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, glm::normalize(Vec3{1, 1, 1})})
    CHECK(small.on(n) == Approx(all.on(n)).epsilon(0.002));
}

TEST_CASE("A picture in cells of directions keeps its light where it is", "[light][sky]") {
  // a bright spot of 3 degrees on a lobe, which directions 10 degrees apart would miss or meet by chance
  const Vec3 spot = direction_from_angles(50, 130);
  const Sky sky = sky_of(picture(1024, [&](const Panorama& p, std::uint32_t r, std::uint32_t c) {
    const Vec3 d = p.direction(r + 0.5, c + 0.5);
    return 1 + (glm::dot(d, spot) > std::cos(0.026) ? 200.0 : 0.0);
  }));
  std::vector<Vec3> directions;
  for (int i = 0; i < 300; ++i) {
    const double z = (i + 0.5) / 300, s = std::sqrt(1 - z * z), a = 2.399963 * i;
    directions.push_back({s * std::cos(a), s * std::sin(a), z});
  }
  const Sky cells = in_cells(sky, directions);
  CHECK(horizontal_irradiance(cells, 800) == Approx(1.0).epsilon(0.003));
  double towards = 0, exact = 0;
  each_part(cells, 200'000,
            [&](const Vec3& d, double light, double) { towards += light / std::max(d.z, 0.01) * std::max(0.0, glm::dot(d, spot)); });
  each_part(sky, 200'000,
            [&](const Vec3& d, double light, double) { exact += light / std::max(d.z, 0.01) * std::max(0.0, glm::dot(d, spot)); });
  CHECK(towards == Approx(exact).epsilon(0.01));  // the cell is 9 degrees wide: its cosine
  CHECK(in_cells(Sky{}, directions).model == SkyModel::uniform);
}

TEST_CASE("A sun of one pixel is found, with its direction and share in closed form", "[light][sky]") {
  for (const std::uint32_t columns : {64u, 360u, 1024u, 4096u}) {
    CAPTURE(columns);
    const std::uint32_t row = columns / 8 + 3, column = columns / 3;  // about 45 degrees high
    auto sunny = picture(columns, [&](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == row && c == column ? 1e6 : 1.0; });
    const Vec3 towards = sunny.direction(row + 0.5, column + 0.5);
    const double pixel = sunny.level_angle(row, row + 1.0), share = (1e6 - 1) * pixel / (1e6 * pixel + pi - pixel);
    const auto sun = take_sun(sunny);
    REQUIRE(sun);
    CHECK(glm::length(sun->direction - towards) < 1e-9);
    CHECK(sun->horizontal_share == Approx(share).epsilon(1e-6));
    CHECK(sky_of(sunny).relative_radiance(towards) == Approx(1 / pi).epsilon(1e-5));  // the sky that was behind it
  }
}

TEST_CASE("A sun is found over a dark sky, wide with a glare, across the picture's edge, and about the zenith", "[light][sky]") {
  auto alone = picture(256, [](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 30 && c == 0 ? 5.0 : 0.0; });
  const auto only = take_sun(alone);
  REQUIRE(only);
  CHECK(only->horizontal_share == Approx(1.0));
  for (const Vec3& middle : {direction_from_angles(40, 179.9), direction_from_angles(89.5, 10), direction_from_angles(3, 300)}) {
    auto wide = picture(1024, [&](const Panorama& p, std::uint32_t r, std::uint32_t c) {
      const double angle = std::acos(std::min(1.0, glm::dot(p.direction(r + 0.5, c + 0.5), middle))) * 180 / pi;
      return 1 + (angle < 0.7 ? 1e4 : angle < 1.8 ? 50.0 : 0.0);
    });
    const auto sun = take_sun(wide);
    REQUIRE(sun);
    CHECK(glm::length(sun->direction - middle) < 0.003);  // half a pixel
    CHECK(*std::max_element(wide.value.begin(), wide.value.end()) == 1.0f);
  }
}

TEST_CASE("What is no sun stays in the picture", "[light][sky]") {
  const auto keeps = [](Panorama p) {
    const auto before = p.value;
    return !take_sun(p) && p.value == before;
  };
  CHECK(keeps(lobe(512, {0, 0, 1})));
  CHECK(keeps(picture(512, [](auto&&...) { return 1.0; })));
  CHECK(keeps(picture(512, [](auto&&...) { return 0.0; })));
  CHECK(keeps(picture(
      8, [](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 1 && c == 1 ? 1e6 : 1.0; })));  // a pixel of 45 degrees
  CHECK(keeps(picture(
      512, [](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 200 && c == 1 ? 1e6 : 1.0; })));  // below the horizon
  CHECK(keeps(picture(512, [](const Panorama& p, std::uint32_t r, std::uint32_t c) {
    return glm::dot(p.direction(r + 0.5, c + 0.5), Vec3{0, 0.6, 0.8}) > std::cos(20 * pi / 180) ? 1e6 : 1.0;  // a wide bright cloud
  })));
}

TEST_CASE("Pictures that are no skies are refused", "[light][sky]") {
  const auto refused = [](Panorama p, const char* with) { CHECK_THROWS_WITH(SkyImage(std::move(p), "sky.hdr"), Catch::Contains(with)); };
  refused({}, "sky.hdr: found 0 x 0 pixels; expected a picture of all directions (equirectangular), twice as wide as high");
  Panorama square;
  square.columns = square.rows = 8;
  square.value.resize(64, 1.0f);
  refused(square, "found 8 x 8 pixels");
  refused(picture(8, [](const Panorama&, std::uint32_t r, std::uint32_t) { return r > 3 ? 1.0 : 0.0; }),
          "a picture that is dark above the horizon");
  for (const double bad : {-1.0, double(NAN), double(INFINITY)})
    refused(picture(8, [&](const Panorama&, std::uint32_t r, std::uint32_t c) { return r == 1 && c == 5 ? bad : 1.0; }),
            "in column 6 of row 2");
  Sky sky;
  sky.model = SkyModel::image;
  CHECK_THROWS_WITH(prepare_sky(sky, "sky"), "sky: found a sky of a picture without any; expected a picture of the sky");
}
