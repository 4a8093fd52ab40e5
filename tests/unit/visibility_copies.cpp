// Rays through instances against the same rays through copies that are written out.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// Turned, mirrored, scaled and tilted copies in groups, ground, and a stretched one.
Scene copies_scene(bool periodic) {
  Scene scene = small_scene(40);
  Stance tilted;
  tilted.position = {0.4, 1.1, 0.2};
  tilted.tilt_deg = 35;
  tilted.scale = 0.7;
  scene.plants[0].placements.push_back(placed(tilted));
  scene.plants[1].placements.push_back({Affine{Mat3{Vec3{1, 0.3, 0}, Vec3{0, 1.5, 0}, Vec3{0, 0.2, 0.8}}, Vec3{-0.5, 0.5, 0.1}}});
  if (periodic) {
    scene.periodic = PeriodicCell{-0.6, -0.4, 0.7, 0.9};
    scene.ground = flat_ground({1.3, 1.3}, {0.05, 0.25}, {3, 2}, {0.1, 0.2});
  }
  check_scene(scene);
  return scene;
}

Vec3 direction(RandomStream& random) {
  const double z = 2 * random.next() - 1, azimuth = 2 * std::numbers::pi * random.next(), r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

}  // namespace

TEST_CASE("Rays through copies meet what rays through facets meet", "[visibility][rays]") {
  const bool periodic = GENERATE(false, true);
  const Scene scene = copies_scene(periodic);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  const RayScene flat(facets), copies(rows);
  CHECK(copies.facet_count() == facets.size());
  CHECK(copies.plant_facets() == facets.plant_facets);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    REQUIRE(rows.row(copies.at(f)) == f);
    REQUIRE(copies.corners(copies.at(f)) == facets.corners[f]);
    REQUIRE(copies.material(copies.at(f)) == facets.optics[f]);
  }
  RandomStream random(3);
  const int n = 20000;
  int hits = 0, other = 0, occluded = 0;
  for (int i = 0; i < n; ++i) {
    const auto start = static_cast<std::uint32_t>(random.next() * static_cast<double>(facets.size()));
    const auto& t = facets.corners[start];
    const double u = random.next(), v = (1 - u) * random.next();
    const Vec3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), d = direction(random);
    const RayHit a = flat.first_hit(p, d, start), b = copies.first_hit(p, d, copies.at(start));
    hits += static_cast<bool>(a);
    occluded += flat.occluded(p, d, start) != copies.occluded(p, d, copies.at(start));
    // Leaves are joined along edges, and cut each other: single precision may take another one there.
    if (static_cast<bool>(a) != static_cast<bool>(b) || (a && rows.row(b.where()) != a.facet)) {
      ++other;
      continue;
    }
    if (!a) continue;
    REQUIRE(a.front == b.front);
    const double slant = std::abs(glm::dot(d, glm::normalize(area_vector(facets.corners[a.facet]))));  // grazing rays err by more
    REQUIRE(std::abs(b.distance - a.distance) * slant < 2e-6);  // of a scene of 10 m, in single precision
    REQUIRE(std::abs(b.u - a.u) * slant < 1e-4);                // of leaves of 0.05 m and more
  }
  CHECK(hits > n / 4);
  CHECK(other < n / 500);
  CHECK(occluded < n / 500);
}

TEST_CASE("Facets of a copy that lie on each other keep their order in every copy", "[visibility][rays][stacked]") {
  // Three equal leaves, the second 1e-9 m above the first in the plant's frame, the third exactly on the first.
  const auto leaf = [](double z) { return Mesh{{{0, 0, z}, {1, 0, z}, {1, 1, z}}, {{0, 1, 2}}}; };
  Scene scene;
  scene.bands = {"PAR"};
  scene.optics = {uniform_optics("leaf", {0.1}, {0.05})};
  scene.states.resize(1);
  Stance upside_down, mirrored;
  upside_down.position = {10, 0, 0};
  upside_down.tilt_deg = 180;
  mirrored.position = {20, 0, 0};
  mirrored.mirror = true;
  scene.plants.push_back(plant_entry("p", make_plant({leaf(0), leaf(1e-9), leaf(0)}), 0,
                                     {sunfleck::placed({}), sunfleck::placed(upside_down), sunfleck::placed(mirrored)}));
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  const RayScene flat(facets), copies(rows);
  CHECK(copies.stacked_pairs() == flat.stacked_pairs());
  for (std::uint32_t start = 0; start < facets.size(); ++start) {
    const auto& t = facets.corners[start];
    const Vec3 p = (t[0] + t[1] + t[2]) / 3.0;
    for (const double up : {1.0, -1.0}) {
      const RayHit a = flat.first_hit(p, {0, 0, up}, start), b = copies.first_hit(p, {0, 0, up}, copies.at(start));
      CHECK(static_cast<bool>(a) == static_cast<bool>(b));
      if (a && b) CHECK(rows.row(b.where()) == a.facet);
      const RayHit c = flat.first_hit(p + Vec3{0, 0, up}, {0, 0, -up}), e = copies.first_hit(p + Vec3{0, 0, up}, {0, 0, -up});
      REQUIRE((c && e));
      CHECK(rows.row(e.where()) == c.facet);
    }
  }
}
