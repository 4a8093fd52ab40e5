// Methods lattice and occlusion: exact layers, balls of leaves, balances, stiff and empty cases.
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include <sunfleck/core/error.hpp>
#include <sunfleck/solver/solution.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using reference_runs::add;
using reference_runs::leaves;
using reference_runs::point_sun;
using reference_runs::scene_with;
using reference_runs::sky;

namespace {

Optics leaf(double rho, double tau) {
  return uniform_optics("leaf", {rho}, {tau});
}

/// Small leaves over a periodic cell of 1 m, 1 m high.
Scene layer(double lai, double rho, double tau, bool sun) {
  auto scene = scene_with({"X"}, {leaf(rho, tau)});
  constexpr double side = 0.02;
  add(scene, "layer", leaves(static_cast<int>(std::lround(lai / (side * side))), side, {1, 1, 1}, 7), 0);
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  if (sun)
    point_sun(scene, {0.6, 0, 0.8}, 125.0);  // 100 on the horizontal
  else
    sky(scene, SkyModel::uniform, 100.0);
  return scene;
}

RunSettings with(const std::string& method) {
  RunSettings run;
  run.method = method;
  run.certificate = false;
  return run;
}

double absorbed(const Solution& solution) {
  double sum = 0;
  for (std::size_t o = 0; o < solution.organs.count; ++o) sum += solution.organs.absorbed_in(o);
  return sum;
}

/// Leaves in a ball of radius 1 m.
Scene ball(double optical_radius, SkyModel model) {
  auto scene = scene_with({"X"}, {leaf(0, 0)});
  constexpr double side = 0.04;
  const auto count = static_cast<std::size_t>(optical_radius * 2.0 * 4.0 / 3.0 * std::numbers::pi / (side * side));
  RandomStream random(11);
  std::vector<Mesh> meshes;
  while (meshes.size() < count) {
    const Vec3 c{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1};
    const double z = 2 * random.next() - 1, azimuth = 2 * std::numbers::pi * random.next(), s = std::sqrt(1 - z * z);
    if (glm::length(c) > 1) continue;
    Vec3 u, v;
    orthonormal_frame({s * std::cos(azimuth), s * std::sin(azimuth), z}, u, v);
    u *= 0.5 * side, v *= 0.5 * side;
    meshes.push_back({{c - u - v, c + u - v, c + u + v, c - u + v}, {{0, 1, 2}, {0, 2, 3}}});
  }
  add(scene, "ball", std::move(meshes), 0);
  sky(scene, model, 100.0);
  return scene;
}

}  // namespace

TEST_CASE("the lattice's layers absorb as discrete ordinates have it", "[lattice]") {
  // Absorbed share of light on an endless layer over black ground; leaves of spherical angles.
  struct Case {
    double lai, rho, tau;
    bool sun;
    double exact, within;
  };
  // In NIR, a lattice of even density is at +17 / +5 / +2 %: here its density is matched by rays. Real leaves differ by .4 % from a turbid
  // layer.
  const auto c =
      GENERATE(Case{1, .09, .05, true, .42520, .01}, Case{3, .09, .05, false, .84084, .012}, Case{1, .45, .40, true, .11113, .02},
               Case{3, .45, .40, true, .31580, .025}, Case{3, .45, .40, false, .32750, .03}, Case{6, .45, .40, true, .49617, .035});
  auto run = with("lattice");
  run.lattice_nodes = 16;
  const auto solution = solve(layer(c.lai, c.rho, c.tau, c.sun), run);
  INFO("LAI " << c.lai << ", rho " << c.rho << (c.sun ? ", sun" : ", diffuse"));
  CHECK(absorbed(solution) / 100.0 == Approx(c.exact).epsilon(c.within));
  const auto& balance = solution.report.balance[0][0];
  CHECK(std::abs(balance.residual()) < 1e-6 * balance.incident);
}

TEST_CASE("the paper's mapping is there to be compared with", "[lattice]") {
  auto run = with("lattice");
  run.lattice_nodes = 16;
  run.lattice_mapping = "paper";
  const auto solution = solve(layer(1, .45, .40, true), run);
  CHECK(absorbed(solution) / 100.0 == Approx(.11113 * 1.28).epsilon(0.06));  // +28 %, as design and prototype have it
  CHECK(std::abs(solution.report.balance[0][0].residual()) < 1e-6 * solution.report.balance[0][0].incident);
}

TEST_CASE("the lattice gives the same bits for any number of threads, and closes its balance in a stand of copies", "[lattice]") {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {.09, .45}, {.05, .40})});
  scene.plants.push_back(plant_entry("bush", make_plant(leaves(400, 0.1, {1, 1, 1}, 3), "bush"), 0,
                                     {placed({}), placed({.position = {4, 1, 0}}), placed({.position = {1, 4, 0}})}));
  scene.ground = flat_ground({10, 10}, {2.5, 2.5}, {20, 20}, {.1, .2});
  point_sun(scene, {0.5, -0.3, 0.8}, 400);
  sky(scene, SkyModel::standard_overcast, 90);
  const auto run = [&](int threads) {
    auto settings = with("lattice");
    settings.threads = threads;
    return solve(scene, settings);
  };
  const auto one = run(1), two = run(2);
  CHECK(one.facets.irradiance == two.facets.irradiance);
  for (const auto& b : one.report.balance[0]) {
    CHECK(std::abs(b.residual()) < 1e-6 * b.incident);
    CHECK(b.escaped > 0.0);
  }
  // each copy has a lattice of its own, turned and moved with it
  for (const auto& [name, n] : one.report.counts)
    if (name == "own_lattices") CHECK(n == 1);
  const auto truth = solve(scene, with("clustering"));
  double off = 0, mean = 0;
  for (std::size_t o = 0; o < truth.organs.count; ++o) {
    if (truth.organs.plant[o] == of_ground) continue;
    off += std::pow(one.organs.absorbed_in(o, 1) - truth.organs.absorbed_in(o, 1), 2);
    mean += truth.organs.absorbed_in(o, 1);
  }
  CHECK(std::sqrt(off / 1200) / (mean / 1200) < 0.2);
}

TEST_CASE("the lattice of one leaf, of no plant, and of leaves that keep nothing", "[lattice]") {
  auto alone = scene_with({"X"}, {leaf(.45, .40)});
  add(alone, "leaf", {reference_runs::square(1.0)}, 0);
  sky(alone, SkyModel::uniform, 100.0);
  CHECK(absorbed(solve(alone, with("lattice"))) == Approx(15.0).epsilon(0.02));  // 1 - rho - tau of 100 W; black below

  auto ground = scene_with({"X"}, {});
  ground.ground = flat_ground({4, 4}, {0, 0}, {4, 4}, {.3});
  sky(ground, SkyModel::uniform, 100.0);
  const auto bare = solve(ground, with("lattice"));
  CHECK(absorbed(bare) == Approx(16 * 70.0).epsilon(1e-3));

  auto white = layer(3, .5, .5, true);
  const auto light = solve(white, with("lattice"));
  CHECK(absorbed(light) == Approx(0.0).margin(1e-3));
  for (const float e : light.facets.irradiance) REQUIRE(std::isfinite(e));
  const auto& balance = light.report.balance[0][0];
  CHECK(balance.escaped == Approx(balance.incident).epsilon(1e-6));
}

TEST_CASE("occlusion's ball of leaves against path tracing", "[occlusion]") {
  for (const double k : {0.5, 2.0}) {
    const auto scene = ball(k, SkyModel::sphere);
    auto tracing = with("reference");
    tracing.samples = 64;
    const auto truth = solve(scene, tracing);
    const auto rms = [&](const char* model) {
      auto run = with("occlusion");
      run.occlusion_model = model;
      const auto found = solve(scene, run);
      // by depth and angle, so that the chance of single leaves is left out
      std::map<std::pair<int, int>, std::array<double, 3>> groups;
      const auto facets = expand(scene);
      for (std::size_t f = 0; f < facets.size(); ++f) {
        const Vec3 middle = (facets.corners[f][0] + facets.corners[f][1] + facets.corners[f][2]) / 3.0;
        const Vec3 normal = glm::normalize(area_vector(facets.corners[f]));
        for (int side = 0; side < 2; ++side) {
          const double cosine = glm::dot(side == 0 ? normal : -normal, glm::normalize(middle));
          auto& group = groups[{static_cast<int>(5 * std::pow(std::min(1.0, glm::length(middle)), 3)), static_cast<int>(3 * (cosine + 1))}];
          const std::size_t at = 2 * f + static_cast<std::size_t>(side);
          group[0] += truth.facets.irradiance[at], group[1] += found.facets.irradiance[at], group[2] += 1;
        }
      }
      double square = 0, all = 0;
      for (const auto& [where, g] : groups) square += std::pow((g[1] - g[0]) / g[2] / 100.0, 2) * g[2], all += g[2];
      return std::sqrt(square / all);
    };
    INFO("k R " << k);
    CHECK(rms("table") < 0.02);
    CHECK(rms("paper") > 3 * rms("table"));
  }
}

TEST_CASE("occlusion's dense stand is a layer: light falls off in it as in one", "[occlusion]") {
  const auto scene = layer(3, 0, 0, false);
  const auto found = solve(scene, with("occlusion")), truth = solve(scene, with("direct"));
  CHECK(absorbed(found) == Approx(absorbed(truth)).epsilon(0.02));
}

TEST_CASE("occlusion's crowns shade each other and the ground", "[occlusion]") {
  auto scene = ball(2.0, SkyModel::uniform);
  scene.plants[0].placements.push_back(placed({.position = {2.2, 0, 0}}));
  scene.ground = flat_ground({8, 8}, {0, 0}, {16, 16}, {0.0});
  scene.ground->height = -1.2;
  const auto found = solve(scene, with("occlusion")), truth = solve(scene, with("direct"));
  double ground[2] = {0, 0}, leaves_of[2] = {0, 0};
  for (std::size_t o = 0; o < truth.organs.count; ++o) {
    auto& sums = truth.organs.plant[o] == of_ground ? ground : leaves_of;
    sums[0] += found.organs.absorbed_in(o), sums[1] += truth.organs.absorbed_in(o);
  }
  CHECK(ground[0] == Approx(ground[1]).epsilon(0.03));
  CHECK(leaves_of[0] == Approx(leaves_of[1]).epsilon(0.05));
}
