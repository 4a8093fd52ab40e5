// Large things beside small ones, inside, on and below the ground, on slopes and in a period, by instantiation against path tracing, which
// shares nothing with it. Leaves are dark, as in the photosynthetic band: where they scatter much, what elements average is the larger
// error.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/instantiation/plan.hpp>
#include <sunfleck/instantiation/solve.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

Run instantiated(const Scene& scene) {
  FacetScene facets = expand(scene);
  Kept kept(scene.states.size(), facets.size(), scene.band_count());
  auto report = solve_instantiation(scene, place(scene), InstantiationSettings{}, kept, silent());
  return {std::move(facets), std::move(kept), std::move(report)};
}

/// By how much what the facets, or the organs, of one plant of a scene absorb is off: relative to the mean, the tracer's own noise taken
/// out; `noise` is what it leaves of the bias.
struct Error {
  double bias = 0, noise = 0, facets = 0, organs = 0;
};

Error error_of(const Run& run, const Run& traced, const std::string& plant) {
  const auto& f = run.facets;
  std::vector<double> difference(f.organs.size(), 0.0), variance(difference), area(difference);
  double square = 0, noise = 0, sum = 0, sum_noise = 0, mean = 0, all = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (f.organs.plants[f.organs.plant[f.organ[i]]] != plant || !(f.area[i] > 0)) continue;
    const double a = f.area[i], d = run.absorbed(i) - traced.absorbed(i), v = traced.kept.variance_of(i);
    square += a * d * d, noise += a * v, sum += a * d, sum_noise += a * a * v, mean += a * traced.absorbed(i), all += a;
    difference[f.organ[i]] += a * d, variance[f.organ[i]] += a * a * v, area[f.organ[i]] += a;
  }
  REQUIRE(mean > 0);
  double organs = 0;
  for (std::size_t o = 0; o < area.size(); ++o)
    if (area[o] > 0) organs += (difference[o] * difference[o] - variance[o]) / area[o];
  const auto relative = [&](double s) { return std::sqrt(std::max(0.0, s) / all) / (mean / all); };
  return {sum / mean, std::sqrt(sum_noise) / mean, relative(square - noise), relative(organs)};
}

/// Path tracing of the first facets of a scene only: of what is large, and placed first, to less noise.
Run trace_first(const Scene& scene, std::uint64_t facets, std::uint32_t samples) {
  FacetScene all = expand(scene);
  Kept kept(scene.states.size(), all.size(), scene.band_count());
  ReferenceSettings settings;
  settings.samples = samples;
  settings.facets = facets;
  auto report = trace_reference(scene, all, settings, kept, silent());
  return {std::move(all), std::move(kept), std::move(report)};
}

/// `n` upright blades of one triangle each in a disc.
std::vector<Mesh> tuft(int n, double width, double height, double radius, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Mesh> out;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * random.next(), r = radius * std::sqrt(random.next()),
                 turn = 2 * std::numbers::pi * random.next();
    const Vec3 foot{r * std::cos(a), r * std::sin(a), 0.002}, across = 0.5 * width * Vec3{std::cos(turn), std::sin(turn), 0};
    const Vec3 lean{0.4 * height * (random.next() - 0.5), 0.4 * height * (random.next() - 0.5), height};
    out.push_back({{foot - across, foot + across, foot + lean}, {{0, 1, 2}}});
  }
  return out;
}

/// 60 leaves about the vertical axis.
std::vector<Mesh> crown() {
  auto out = leaves(60, 0.1, {0.7, 0.7, 0.9}, 3);
  for (auto& mesh : out)
    for (auto& p : mesh.vertices) p -= Vec3{0.35, 0.35, 0};
  return out;
}

Mesh rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {{corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}}};
}

const std::vector<Optics> optics{uniform_optics("leaf", {0.08}, {0.05}), uniform_optics("wall", {0.3}, {0.0}),
                                 uniform_optics("film", {0.12}, {0.8})};

Scene lit(std::array<double, 2> ground, const Vec3& sun = {0.3, -0.4, 0.8}) {
  auto scene = scene_with({"P"}, optics);
  scene.ground = flat_ground(ground, {0, 0}, {16, 16}, {0.15});
  sky(scene, SkyModel::standard_overcast, 100);
  point_sun(scene, sun, 400);
  return scene;
}

void place_grid(Scene& scene, int n, double step, double z = 0) {
  auto& places = scene.plants.back().placements;
  places.clear();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      places.push_back({Affine::translate({step * (i - 0.5 * (n - 1)), step * (j - 0.5 * (n - 1)), z}) * Affine::turn(1.9 * i + 0.7 * j)});
}

}  // namespace

TEST_CASE("instantiation: a large leaf half under a roof, beside small ones, is half sunlit", "[instantiation][mixtures]") {
  auto scene = scene_with({"P"}, optics);
  add(scene, "big", {rectangle({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0})}, 0);
  add(scene, "roof", {rectangle({0, -0.75, 0.5}, {0.75, 0, 0}, {0, 1.5, 0})}, 0);
  add(scene, "small", {rectangle({0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0})}, 0);
  scene.plants.back().placements = {{Affine::translate({2, 0, 1})}, {Affine::translate({2, 1.5, 1})}};
  point_sun(scene, {0, 0, 1}, 400);
  const auto run = instantiated(scene);
  double lit = 0;
  for (std::size_t f = 0; f < 2; ++f) lit += run.facets.area[f] * run.kept.sunlit[2 * f];
  CHECK(lit == Approx(0.5).margin(0.005));
}

TEST_CASE("instantiation: mixtures are lit as path tracing lights them", "[instantiation][mixtures]") {
  const auto judge = [](const char* name, const Scene& scene, const char* small, Error wanted, std::vector<const char*> large = {}) {
    const auto run = instantiated(scene), traced = reference_runs::trace(scene, 64);
    const auto check = [&](const char* plant, const Error& e, const Error& most) {
      CAPTURE(name, plant, e.bias, e.noise, e.facets, e.organs);
      CHECK(std::abs(e.bias) < most.bias + 3 * e.noise);
      CHECK(e.facets < most.facets);
      CHECK(e.organs < most.organs);
    };
    check(small, error_of(run, traced, small), wanted);
    if (large.empty()) return;
    std::uint64_t facets = 0;
    for (std::size_t p = 0; p < large.size(); ++p) facets += scene.plants[p].plant->facet_count() * scene.plants[p].placements.size();
    const auto few = trace_first(scene, facets, 1 << 14);
    for (const auto* plant : large) check(plant, error_of(run, few, plant), {0.005, 0, 0.01, 0.01});
  };
  SECTION("a wall and an eave beside tufts") {
    auto scene = lit({6, 6}, {0.2, -0.5, 0.8});
    add(scene, "wall", {rectangle({-1.5, 0.4, 0.01}, {3, 0, 0}, {0, 0, 2})}, 1);
    add(scene, "eave", {rectangle({-1.5, -0.2, 2.1}, {3, 0, 0}, {0, 0.6, 0})}, 1);
    add(scene, "tuft", tuft(40, 0.01, 0.25, 0.15, 3), 0);
    place_grid(scene, 6, 0.4);
    judge("wall", scene, "tuft", {0.005, 0, 0.02, 0.02}, {"wall", "eave"});
  }
  SECTION("panels over tufts") {
    auto scene = lit({6, 6}, {0, -0.94, 0.34});
    add(scene, "panel", {rectangle({-1, -0.4, 0.8}, {2, 0, 0}, {0, 0.8, 0.4})}, 1);
    scene.plants.back().placements = {{Affine::translate({0, -0.6, 0})}, {Affine::translate({0, 0.9, 0})}};
    add(scene, "tuft", tuft(40, 0.01, 0.25, 0.15, 3), 0);
    place_grid(scene, 6, 0.4);
    judge("panels", scene, "tuft", {0.005, 0, 0.02, 0.02}, {"panel"});
  }
  SECTION("plants in a house of film") {
    auto scene = lit({6, 6});
    add(scene, "house",
        {rectangle({-1.6, -1.6, 1.4}, {3.2, 0, 0}, {0, 3.2, 0.3}), rectangle({-1.6, -1.6, 0.01}, {3.2, 0, 0}, {0, 0, 1.3}),
         rectangle({-1.6, -1.6, 0.01}, {0, 3.2, 0}, {0, 0, 1.3}), rectangle({1.6, -1.6, 0.01}, {0, 3.2, 0}, {0, 0, 1.3})},
        2);
    add(scene, "crown", crown(), 0);
    place_grid(scene, 3, 0.9);
    judge("house", scene, "crown", {0.005, 0, 0.08, 0.05}, {"house"});  // film over leaves: bright to one side
  }
  SECTION("behind a ridge of the ground") {
    auto scene = lit({6, 6}, {0, -0.9, 0.35});
    Mesh ridge;
    for (int j = 0; j <= 20; ++j)
      for (int i = 0; i <= 1; ++i) {
        const double y = -4 + 0.4 * j;
        ridge.vertices.push_back({8.0 * i - 4, y, std::max(0.0, 1.5 - std::abs(y + 1.5))});
      }
    for (std::uint32_t j = 0; j < 20; ++j) {
      ridge.triangles.push_back({2 * j, 2 * j + 1, 2 * j + 3});
      ridge.triangles.push_back({2 * j, 2 * j + 3, 2 * j + 2});
    }
    scene.ground->mesh = ridge;
    add(scene, "crown", crown(), 0);
    scene.plants.back().placements.clear();
    for (int i = 0; i < 4; ++i) scene.plants.back().placements.push_back({Affine::translate({i - 2.0, 0.3 + 0.8 * (i % 2), 0.02})});
    judge("ridge", scene, "crown", {0.005, 0, 0.03, 0.03});
  }
  SECTION("some of them under flat ground") {
    auto scene = lit({60, 60});
    add(scene, "crown", crown(), 0);
    place_grid(scene, 2, 1.0);
    scene.plants.back().placements.push_back({Affine::translate({0.2, 0.2, -1.1})});
    const auto run = instantiated(scene);
    double most = 0;
    for (std::size_t f = 4 * 120; f < 5 * 120; ++f)
      for (int side = 0; side < 2; ++side) most = std::max(most, run.kept.on(f, side));
    CHECK(most < 2);  // what comes in below the far edge of the ground
    judge("under", scene, "crown", {0.005, 0, 0.03, 0.03});
  }
  SECTION("a large leaf over tufts in a period") {
    auto scene = lit({1.2, 1.2});
    scene.periodic = PeriodicCell{-0.6, -0.6, 0.6, 0.6};
    add(scene, "leaf", {rectangle({-0.4, -0.3, 0.5}, {0.8, 0, 0.1}, {0, 0.6, 0})}, 0);
    add(scene, "tuft", tuft(40, 0.01, 0.25, 0.15, 3), 0);
    place_grid(scene, 3, 0.4);
    judge("period", scene, "tuft", {0.005, 0, 0.02, 0.02}, {"leaf"});
  }
}

TEST_CASE("instantiation: no light gets into a closed box", "[instantiation][mixtures]") {
  auto scene = lit({4, 4});
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, low{-0.5, -0.5, 0.001};
  auto meshes = std::vector<Mesh>{rectangle(low, y, x),     rectangle(low + z, x, y), rectangle(low, x, z),
                                  rectangle(low + y, z, x), rectangle(low, z, y),     rectangle(low + x, y, z)};
  meshes.push_back(rectangle({-0.2, -0.2, 0.4}, 0.4 * x, 0.4 * y));
  meshes.push_back(rectangle({1.0, -0.2, 0.4}, 0.4 * x, 0.4 * y));
  add(scene, "box", meshes, 1);
  const auto run = instantiated(scene);
  for (std::size_t f = 12; f < 14; ++f)
    for (int side = 0; side < 2; ++side) CHECK(run.kept.on(f, side) == 0);
  CHECK(run.kept.on(14, 0) > 100);
}

TEST_CASE("a sun at the horizon of a scene without end brings what falls on level ground, by every method", "[instantiation][mixtures]") {
  auto scene = scene_with({"P"}, {uniform_optics("leaf", {0.0}, {0.0})});
  scene.periodic = PeriodicCell{0, 0, 1, 1};
  scene.ground = flat_ground({1, 1}, {0.5, 0.5}, {2, 2}, {0.0});
  add(scene, "leaves", leaves(60, 0.2, {1, 1, 0.6}, 3), 0);
  const double elevation = GENERATE(0.3, 0.03, 0.005);
  const double z = std::sin(elevation * std::numbers::pi / 180);
  point_sun(scene, {std::sqrt(1 - z * z) * 0.6, std::sqrt(1 - z * z) * 0.8, z}, 1000);
  const double arrives = 1000 * z;  // on the cell's square metre, all of it absorbed
  const auto absorbed = [](const Run& run) {
    double sum = 0;
    for (std::size_t f = 0; f < run.facets.size(); ++f) sum += run.facets.area[f] * run.absorbed(f);
    return sum;
  };
  CAPTURE(elevation);
  if (elevation > 0.1) CHECK(absorbed(reference_runs::trace(scene, 1024)) == Approx(arrives).epsilon(0.1));  // lower, too few paths meet it
  CHECK(absorbed(solve(scene, RadiosityMethod::clustering)) == Approx(arrives).epsilon(0.1));
  CHECK(absorbed(solve(scene, RadiosityMethod::flat)) == Approx(arrives).epsilon(0.1));
  const double shared = absorbed(instantiated(scene));
  if (elevation > 0.01)
    CHECK(shared == Approx(arrives).epsilon(0.1));
  else
    CHECK(shared < 2 * arrives);  // one cell is lit, by a byte's least values
}
