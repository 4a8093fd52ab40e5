// `only` and `stop_at`: what is opened is lit as if all were, and what stays closed absorbs what its leaves would.
#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/instantiation/solve.hpp>
#include <sunfleck/reference/path_tracer.hpp>
#include <sunfleck/result/structure_sums.hpp>

#include "radiosity_runs.hpp"

using namespace sunfleck;
using namespace radiosity_runs;

namespace {

struct Opened {
  PlacedScene placed;
  Kept kept;
  SolveReport report;
  /// Absorbed power of an organ (row of the result) [W].
  double power(const FacetRows& rows, std::uint64_t organ, std::size_t band) const {
    const auto [copy, local] = rows.organ_at(organ);
    double sum = 0;
    for (const auto f : rows.organ_facets(copy, local)) {
      const auto& m = rows.materials()[rows.material({copy, f})];
      const double area = glm::length(area_vector(rows.corners({copy, f})));
      const auto row = rows.row({copy, f});
      sum += area * ((1.0 - m.reflectance_front[band] - m.transmittance[band]) * kept.on(row, 0, band) +
                     (1.0 - m.reflectance_back[band] - m.transmittance[band]) * kept.on(row, 1, band));
    }
    return sum;
  }
};

Opened opened(const Scene& scene, const Depth& depth = {}) {
  PlacedScene placed = place(scene, depth);
  Kept kept(scene.states.size(), placed.facets, scene.band_count());
  auto report = solve_instantiation(scene, placed, InstantiationSettings{}, kept, silent());
  return {std::move(placed), std::move(kept), std::move(report)};
}

/// Rows of five crowns of 100 leaves, rows in tiles of three, `tiles` of them along y.
Scene orchard(std::uint32_t tiles) {
  auto scene = scene_with({"PAR", "NIR"}, {uniform_optics("leaf", {0.09, 0.45}, {0.05, 0.40})});
  scene.ground = flat_ground({12, 7.0 * tiles}, {4, 3.2 * tiles}, {1, 1}, {0.12, 0.2});
  add(scene, "crown", leaves(100, 0.12, {1, 1, 1}, 3), 0);
  scene.plants[0].placements.clear();
  GroupEntry row, tile, stand;
  row.name = "row", tile.name = "tile", stand.name = "stand";
  for (int i = 0; i < 5; ++i) row.members.push_back({false, 0, {Affine::translate({1.6 * i, 0, 0.1 * (i % 2)}) * Affine::turn(1.1 * i)}});
  for (int i = 0; i < 3; ++i) tile.members.push_back({true, 0, {Affine::translate({0, 2.0 * i, 0})}});
  for (std::uint32_t i = 0; i < tiles; ++i) stand.members.push_back({true, 1, {Affine::translate({0, 6.2 * i, 0})}});
  stand.placements.push_back({});
  scene.groups = {row, tile, stand};
  sky(scene, SkyModel::standard_overcast, 100);
  scene.states[0].sun = Sun{glm::normalize(Vec3{0.2, 0.5, 0.8}), {400, 400}, 0.53};
  return scene;
}

}  // namespace

TEST_CASE("only: a tile is lit in its surroundings as when all tiles are opened; groups farther away are never entered") {
  auto scene = orchard(5);
  const auto all = opened(scene);
  const auto one = opened(scene, {{"stand/tile 2"}, {}});
  CHECK(all.placed.copies.size() == 75);
  CHECK(one.placed.copies.size() == 15);
  CHECK(one.placed.paths.front() == "stand[0]/tile[2]/row[0]/crown[0]");
  const FacetRows rows(scene, one.placed), all_rows(scene, all.placed);
  for (std::size_t band = 0; band < 2; ++band) {
    std::vector<double> a, b;
    for (std::uint64_t organ = 0; organ < 1500; ++organ) {
      a.push_back(one.power(rows, organ, band));
      b.push_back(all.power(all_rows, 2 * 1500 + organ, band));
    }
    CAPTURE(band, relative_rms(a, b));
    CHECK(relative_rms(a, b) < 0.026);  // the sun's grid and the rays between copies differ: about 1.5 % each
  }
  // 10^7 tiles beside it cost nothing: the same copies are listed
  auto large = orchard(5);
  GroupEntry world;
  world.name = "world";
  for (int i = 0; i < 3000; ++i) world.members.push_back({true, 2, {Affine::translate({60.0 * i, 0, 0})}});
  world.placements.push_back({});
  large.groups[2].placements.clear();
  for (int i = 0; i < 3000; ++i) large.groups[2].members.push_back({true, 1, {Affine::translate({0, 31 + 6.2 * i, 0})}});
  large.groups.push_back(world);
  large.ground.reset();
  const auto placed = place(large, {{"world/stand 0/tile 2"}, {}});
  CHECK(placed.copies.size() == 15);
  CHECK(placed.near.size() < 200);
  CHECK(placed.far.size() < 20000);
  CHECK(placed.closed.size() == 2999 + 3004);
}

TEST_CASE("only: of a plant that stands far away only, the first copy stands for all") {
  auto scene = orchard(1);
  add(scene, "bush", leaves(2500, 0.06, {2, 2, 1}, 5), 0);
  scene.plants[1].placements.clear();
  // groups of bushes, so many that they are not solved with the tile
  GroupEntry hedge;
  hedge.name = "hedge";
  for (int i = 0; i < 210; ++i) hedge.members.push_back({false, 1, {Affine::translate({2.5 * (i % 15), 30 + 2.5 * (i / 15), 0})}});
  hedge.placements = {{}, {Affine::translate({0, 40, 0})}};
  scene.groups.push_back(hedge);
  scene.ground = flat_ground({60, 160}, {10, 60}, {1, 1}, {0.12, 0.2});
  const auto run = opened(scene, {{"stand"}, {}});
  REQUIRE(run.placed.closed.size() == 2);
  CHECK(run.placed.near.empty());
  CHECK(run.placed.far.size() > 50);  // within 50 heights
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK_FALSE(run.placed.closed[k].solved);
    for (std::size_t band = 0; band < 2; ++band) CHECK(run.report.structures[k * 2 + band] > 0);
  }
  CHECK(run.report.structures[0] == Approx(run.report.structures[2]).epsilon(1e-9));  // the same bushes
}

TEST_CASE("only: what is opened agrees with path tracing through the whole scene") {
  auto scene = orchard(3);
  const auto run = opened(scene, {{"stand 0/tile 1/row 1"}, {}});
  const PlacedScene wide = with_surroundings(run.placed);
  ReferenceSettings settings;
  settings.samples = 256;
  settings.facets = run.placed.facets;
  Kept kept(1, run.placed.facets, 2);
  trace_reference(scene, FacetRows(scene, wide), settings, kept, silent());
  const FacetRows rows(scene, run.placed);
  const Opened traced{run.placed, std::move(kept), {}};
  for (std::size_t band = 0; band < 2; ++band) {
    std::vector<double> a, b;
    double sum_a = 0, sum_b = 0;
    for (std::uint64_t organ = 0; organ < run.placed.organs; ++organ) {
      a.push_back(run.power(rows, organ, band));
      b.push_back(traced.power(rows, organ, band));
      sum_a += a.back(), sum_b += b.back();
    }
    CAPTURE(band, relative_rms(a, b));
    CHECK(relative_rms(a, b) < (band == 0 ? 0.03 : 0.04));  // leaves of two facets: 256 paths a facet leave 2 % of noise
    CHECK(sum_a == Approx(sum_b).epsilon(0.006));
  }
}

TEST_CASE("only: the rim of a stand, beside open ground, agrees with path tracing of all of it") {
  auto scene = orchard(3);
  scene.ground = flat_ground({80, 80}, {4, 0}, {1, 1}, {0.12, 0.4});
  ReferenceSettings settings;
  settings.samples = 128;
  settings.facets = 1000;  // of the first row
  const PlacedScene whole = place(scene);
  Kept kept(1, whole.facets, 2);
  trace_reference(scene, FacetRows(scene, whole), settings, kept, silent());
  const FacetRows whole_rows(scene, whole);
  const Opened traced{whole, std::move(kept), {}};
  const auto run = opened(scene, {{"stand 0/tile 0/row 0"}, {}});
  const FacetRows rows(scene, run.placed);
  for (std::size_t band = 0; band < 2; ++band) {
    double a = 0, b = 0;
    for (std::uint64_t organ = 0; organ < 500; ++organ) a += run.power(rows, organ, band), b += traced.power(whole_rows, organ, band);
    CAPTURE(band, a, b);
    CHECK(a == Approx(b).epsilon(0.006));
  }
}

TEST_CASE("stop_at: closed plants, groups and structures absorb what their leaves do, and the balance closes with them") {
  auto scene = orchard(1);
  const auto all = opened(scene);
  const FacetRows all_rows(scene, all.placed);
  std::vector<double> tree(15 * 2, 0.0);
  for (std::uint64_t organ = 0; organ < 1500; ++organ)
    for (std::size_t band = 0; band < 2; ++band) tree[organ / 100 * 2 + band] += all.power(all_rows, organ, band);
  for (const char* type : {"plant", "crown", "row", "tile"}) {
    Depth depth;
    depth.stop_at.type = type;
    const auto closed = opened(scene, depth);
    const std::size_t n = type == std::string("tile") ? 1 : type == std::string("row") ? 3 : 15;
    CAPTURE(type);
    REQUIRE(closed.placed.closed.size() == n);
    CHECK(closed.placed.copies.empty());
    for (std::size_t band = 0; band < 2; ++band) {
      for (std::size_t k = 0; k < n; ++k) {
        double leaves = 0;
        for (std::size_t t = k * 15 / n; t < (k + 1) * 15 / n; ++t) leaves += tree[t * 2 + band];
        // the coarse operator stands in for the fine one; 100 leaves average most of the difference out
        CHECK(closed.report.structures[k * 2 + band] == Approx(leaves).epsilon(0.015));
      }
      CHECK(closed.report.balance[0][band].leaves == Approx(all.report.balance[0][band].leaves).epsilon(0.005));
    }
  }
}

TEST_CASE("stop_at: inside plants the sums of facets are kept, and nothing is lost") {
  auto scene = orchard(1);
  Depth depth;
  depth.stop_at.size = 1e-3;
  {
    const auto placed = place(scene, depth);
    CHECK_THROWS_AS(structures_layout(scene, placed), InputError);  // no leaf is that small
  }
  depth.stop_at.size = 0.5;  // every leaf
  const auto placed = place(scene, depth);
  REQUIRE(stops_inside(placed));
  const auto layout = structures_layout(scene, placed);
  CHECK(layout.copies.empty());
  REQUIRE(layout.closed.size() == 1500);
  Kept ground(1, layout.facets, 2), facets(1, placed.facets, 2);
  StructureSums sums(scene, placed, layout, ground);
  auto report = solve_instantiation(scene, placed, InstantiationSettings{}, sums, silent());
  sums.append(report.structures);
  solve_instantiation(scene, placed, InstantiationSettings{}, facets, silent());
  const Opened all{placed, std::move(facets), {}};
  const FacetRows rows(scene, placed);
  for (std::uint64_t organ = 0; organ < 1500; organ += 7)
    for (std::size_t band = 0; band < 2; ++band)
      REQUIRE(report.structures[organ * 2 + band] == Approx(all.power(rows, organ, band)).epsilon(1e-6));
}

TEST_CASE("only: patterns that meet nothing, or say nothing, are refused with what there is") {
  auto scene = orchard(1);
  scene.file = "orchard.toml";
  for (const char* pattern : {"stand 3", "tile 0", "stand/tile 0/row 9", "stand/*/row[1]/crown 5"}) {
    CAPTURE(pattern);
    CHECK_THROWS_WITH(place(scene, {{pattern}, {}}),
                      Catch::Contains("orchard.toml: solve.only: found \"" + std::string(pattern)) && Catch::Contains("stand[0]"));
  }
  CHECK_THROWS_WITH(place(scene, {{"stand//row"}, {}}), Catch::Contains("expected a path of placements"));
  const Depth two{{"stand/*/row[1]/crown 4", "stand/tile/row 0/crown[0]"}, {}};
  CHECK(place(scene, two).paths == std::vector<std::string>{"stand[0]/tile[0]/row[0]/crown[0]", "stand[0]/tile[0]/row[1]/crown[4]"});
}
