// Visibility in balls of leaves against closed forms, and how plants become shells.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/occlusion/ball_visibility.hpp>
#include <sunfleck/occlusion/crown_shells.hpp>
#include <sunfleck/plant/build.hpp>

#include "occlusion/ambient_light.hpp"
#include "occlusion/leaf_layer.hpp"
#include "occlusion/shell_grid.hpp"
#include "reference_runs.hpp"

using namespace sunfleck;

namespace {

Sky sky_of(SkyModel model) {
  Sky sky;
  sky.model = model;
  sky.irradiance = {1.0};
  return sky;
}

/// Small leaves in a ball.
std::vector<Mesh> ball(std::size_t count, double side, double radius, const Vec3& centre, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Mesh> out;
  while (out.size() < count) {
    const Vec3 c{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
    const double z = 2 * random.next() - 1, azimuth = 6.283185307179586 * random.next(), s = std::sqrt(1 - z * z);
    if (glm::length(c) > 1) continue;
    Vec3 u, v;
    orthonormal_frame({s * std::cos(azimuth), s * std::sin(azimuth), z}, u, v);
    u *= 0.5 * side, v *= 0.5 * side;
    const Vec3 at = centre + radius * c;
    out.push_back({{at - u - v, at + u - v, at + u + v, at - u + v}, {{0, 1, 2}, {0, 2, 3}}});
  }
  return out;
}

}  // namespace

TEST_CASE("a ball of leaves is seen through as closed forms have it", "[occlusion]") {
  for (const double k : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const double inward = 2 * (1 - (1 + 2 * k) * std::exp(-2 * k)) / (4 * k * k);
    const BallTable table(k);
    CHECK(ball_visibility({0, 0.3}, k) == Approx(std::exp(-k)).epsilon(1e-5));
    CHECK(ball_visibility({1, 1}, k) == Approx(1.0).epsilon(1e-6));
    CHECK(ball_visibility({1, -1}, k) == Approx(inward).epsilon(1e-4));
    CHECK(ball_transmission(k) == Approx(inward).epsilon(1e-12));
    CHECK(table.at({0, -0.4}) == Approx(std::exp(-k)).epsilon(5e-3));
    CHECK(table.at({1, 1}) == Approx(1.0).epsilon(5e-3));
    CHECK(table.at({1, -1}) == Approx(inward).epsilon(5e-3));
    CHECK(cap_visibility({0, 0.7}, k) == Approx(std::exp(-k)).epsilon(1e-12));  // by which the paper's density is set
  }
  CHECK(ball_visibility({0.5, 0.5}, 0.0) == Approx(1.0));
}

TEST_CASE("a table of 256 values is within .014 of the ball, the paper's formula is not", "[occlusion]") {
  RandomStream random(1);
  for (const auto& [k, bound] : {std::pair{0.5, 0.004}, {1.0, 0.006}, {2.0, 0.01}, {4.0, 0.016}}) {
    const BallTable table(k);
    double square = 0, paper = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      const BallPlace place{std::cbrt(random.next()), 2 * random.next() - 1};
      const double truth = ball_visibility(place, k);
      square += std::pow(table.at(place) - truth, 2), paper += std::pow(cap_visibility(place, k) - truth, 2);
    }
    CHECK(std::sqrt(square / n) < bound);
    CHECK(std::sqrt(paper / n) > 5 * bound);
  }
}

TEST_CASE("nine numbers bring the light of skies to any side", "[occlusion]") {
  for (const auto model : {SkyModel::uniform, SkyModel::standard_overcast, SkyModel::sphere}) {
    AmbientLight light;
    for (const auto& d : sky_directions(sky_of(model), 64)) light.add(d.towards, d.light);
    CHECK(light.on({0, 0, 1}) == Approx(1.0).epsilon(0.02));
    if (model == SkyModel::uniform) {
      CHECK(light.on({1, 0, 0}) == Approx(0.5).epsilon(0.02));
      CHECK(light.on({0, 0, -1}) == Approx(0.0).margin(0.01));
      CHECK(light.mean_direction().z == Approx(0.5).epsilon(0.01));
    }
    if (model == SkyModel::sphere) {
      CHECK(light.on({0.6, 0, -0.8}) == Approx(1.0).epsilon(0.02));
      CHECK(glm::length(light.mean_direction()) < 0.02);
    }
  }
}

TEST_CASE("a ball of leaves is one shell, two balls are two", "[occlusion]") {
  const auto one = crown_shells(make_plant(ball(3000, 0.03, 1.0, {0, 0, 2}, 1), "crown"));
  REQUIRE(one.shells.size() == 1);
  CHECK(one.shells[0].radius == Approx(1.0).epsilon(0.02));
  CHECK(glm::distance(one.shells[0].centre, Vec3{0, 0, 2}) < 0.03);
  CHECK(one.shells[0].leaf_area == Approx(3000 * 0.0009).epsilon(1e-9));
  CHECK(one.of_facet.size() == 6000);
  auto both = ball(1500, 0.03, 0.5, {-2, 0, 2}, 1);
  const auto other = ball(1500, 0.03, 0.5, {2, 0, 2}, 2);
  both.insert(both.end(), other.begin(), other.end());
  const auto two = crown_shells(make_plant(both, "tufts"));
  REQUIRE(two.shells.size() == 2);
  CHECK(std::abs(two.shells[0].centre.x) == Approx(2.0).epsilon(0.02));
  CHECK(two.of_facet.front() != two.of_facet.back());
}

TEST_CASE("a leaf by itself is not shaded by itself", "[occlusion]") {
  const auto shells = crown_shells(make_plant({reference_runs::square(1.0)}, "leaf"));
  REQUIRE(shells.shells.size() == 1);
  CHECK(shells.shells[0].optical_radius() == 0.0);
}

TEST_CASE("rays between crowns meet as much as lies along them", "[occlusion]") {
  CrownShell shell;
  shell.radius = 1.0, shell.leaf_area = 2.0;  // k = 3 / (4 pi)
  std::vector<CrownShell> row(3, shell);
  for (int i = 0; i < 3; ++i) row[static_cast<std::size_t>(i)].centre = {4.0 * i, 0, 0};
  const double k = shell.extinction();
  const ShellGrid grid(row, std::nullopt);
  CHECK(grid.optical_depth({-3, 0, 0}, {1, 0, 0}, ShellGrid::none) == Approx(3 * 2 * k));
  CHECK(grid.optical_depth({0, 0, 0}, {1, 0, 0}, 0) == Approx(2 * 2 * k));
  CHECK(grid.optical_depth({0, 0, 0}, {0, 0, 1}, ShellGrid::none) == Approx(k));
  CHECK(grid.optical_depth({-3, 0.6, 0}, {1, 0, 0}, ShellGrid::none) == Approx(3 * 1.6 * k));
  // one crown in a periodic cell of 4 m: along x there is one every 4 m
  const ShellGrid endless({shell}, PeriodicCell{-2, -2, 2, 2});
  const Vec3 flat = glm::normalize(Vec3{1, 0, 0.02});
  const double met = endless.optical_depth({0, 0, 0}, flat, 0);
  double expected = 0;
  for (int i = 1; i < 100; ++i) {
    CrownShell image = shell;
    image.centre.x = 4.0 * i;
    expected += k * image.chord({0, 0, 0}, flat, 0, 1e9);
  }
  CHECK(met == Approx(std::min(expected, met)).epsilon(1e-9));
  CHECK(met == Approx(expected).epsilon(1e-6));
}

TEST_CASE("a layer of leaves dims an even sky by twice the third exponential integral", "[occlusion]") {
  // E(tau) = 2 integral of mu exp(-tau / mu) d mu
  const LayerLight light(sky_of(SkyModel::uniform), 3.0);
  for (const double tau : {0.0, 0.1, 0.5, 1.0, 2.0, 3.0}) {
    double exact = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double mu = (i + 0.5) / n;
      exact += 2 * mu * std::exp(-tau / mu) / n;
    }
    CHECK(light.on(1.0, tau) == Approx(exact).epsilon(0.01));
  }
  CHECK(light.on(0.0, 0.0) == Approx(0.5).epsilon(0.01));
  CHECK(light.on(-1.0, 0.0) == Approx(0.0).margin(1e-6));
}
