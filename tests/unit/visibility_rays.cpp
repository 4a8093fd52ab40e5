// Rays: sides, self-exclusion, stacked facets, periodic images, scale and offset.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <tbb/global_control.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/rays.hpp>

using namespace sunfleck;

namespace {

FacetScene facets(const std::vector<Triangle>& triangles, std::optional<PeriodicCell> periodic = {}) {
  FacetScene scene;
  for (const auto& t : triangles) {
    scene.corners.push_back(t);
    scene.area.push_back(static_cast<float>(glm::length(area_vector(t))));
    scene.optics.push_back(0);
    scene.organ.push_back(0);
    if (scene.area.back() > 0)
      for (const auto& p : t) scene.bounds.add(p);
    else
      ++scene.zero_area_facets;
  }
  scene.plant_facets = triangles.size();
  scene.periodic = periodic;
  return scene;
}

Triangle flat(double z, double x = 0, double y = 0, double size = 1) {
  return {Vec3{x, y, z}, Vec3{x + size, y, z}, Vec3{x, y + size, z}};
}
Triangle flipped(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

std::vector<Triangle> leaves(int n, double extent, double size, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Triangle> out;
  for (int i = 0; i < n; ++i) {
    Vec3 c, a, b;
    for (auto* v : {&c, &a, &b}) *v = {random.next() - 0.5, random.next() - 0.5, random.next() - 0.5};
    c *= extent;
    out.push_back({c, c + size * a, c + size * b});
  }
  return out;
}

Vec3 direction(RandomStream& random) {
  const double z = 2 * random.next() - 1, azimuth = 6.283185307179586 * random.next(), s = std::sqrt(1 - z * z);
  return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

}  // namespace

TEST_CASE("a ray meets the front of what it sees counter-clockwise") {
  const auto scene = facets({flat(0)});
  const RayScene rays(scene);
  const auto down = rays.first_hit({0.2, 0.3, 2}, {0, 0, -1});
  REQUIRE(down);
  CHECK(down.facet == 0);
  CHECK(down.front);
  CHECK(down.distance == Approx(2).epsilon(1e-6));
  CHECK(down.u == Approx(0.2).epsilon(1e-5));
  CHECK(down.v == Approx(0.3).epsilon(1e-5));
  CHECK_FALSE(rays.first_hit({0.2, 0.3, -2}, {0, 0, 1}).front);
  CHECK_FALSE(rays.first_hit({0.2, 0.3, 2}, {0, 0, 1}));
  CHECK_FALSE(rays.first_hit({0.2, 0.3, 2}, {0, 0, -1}, no_facet, 1.5));
  CHECK(rays.first_hit({0.2, 0.3, 2}, {0, 0, -1}, no_facet, 2.5));
  CHECK(rays.occluded({0.2, 0.3, 2}, {0, 0, -1}));
  CHECK_FALSE(rays.occluded({0.8, 0.8, 2}, {0, 0, -1}));
  CHECK(rays.bytes() > 0);
}

TEST_CASE("a tree that one thread has built leaves the others to the rest of the program") {
  const auto threads = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const std::size_t before = threads();
  const auto scene = facets({flat(0)});
  const RayScene rays(scene);
  CHECK(threads() == before);
}

TEST_CASE("rays do not meet the facet on which they start, nor facets without area") {
  const auto scene = facets({flat(0), {Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{0.5, 0.5, 1}}});
  const RayScene rays(scene);
  RandomStream random(3);
  for (int i = 0; i < 1000; ++i) CHECK_FALSE(rays.occluded({0.4 * random.next(), 0.4 * random.next(), 0}, direction(random), 0));
}

TEST_CASE("a ray that is not finite never reaches the tracer") {
  const auto scene = facets({flat(0)});
  const RayScene rays(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(rays.first_hit({nan, 0, 0}, {0, 0, 1}), Error);
  CHECK_THROWS_AS(rays.occluded({0, 0, 0}, {0, nan, 1}), Error);
  CHECK_THROWS_AS(rays.first_hit({0, 0, 0}, {0, 0, 0}), Error);
}

TEST_CASE("facets that lie on each other have one order for all rays") {
  // the same leaf three times, the second upside down: the higher row is the upper one
  const auto scene = facets({flat(0), flipped(flat(0)), flat(0)});
  const RayScene rays(scene);
  CHECK(rays.stacked_pairs() == 3);
  RandomStream random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{0.49 * random.next() + 0.005, 0.49 * random.next() + 0.005, 0};
    Vec3 d = direction(random);
    if (std::abs(d.z) < 0.05) continue;
    if (d.z > 0) d = -d;
    const auto from_above = rays.first_hit(p - 3.0 * d, d), from_below = rays.first_hit(p + 3.0 * d, -d);
    REQUIRE(from_above.facet == 2);
    REQUIRE(from_above.front);
    REQUIRE(from_below.facet == 0);
    REQUIRE_FALSE(from_below.front);
    // between them
    const auto up = rays.first_hit(p, -d, 0), down = rays.first_hit(p, d, 2);
    REQUIRE(up.facet == 1);
    REQUIRE(up.front);  // it lies upside down
    REQUIRE(up.distance == 0.0);
    REQUIRE(down.facet == 1);
    REQUIRE_FALSE(down.front);
    REQUIRE_FALSE(rays.occluded(p, d, 0));
    REQUIRE_FALSE(rays.occluded(p, -d, 2));
    REQUIRE(rays.occluded(p, -d, 1));
  }
}

TEST_CASE("a leaf on the ground hides the ground only where it lies") {
  auto scene =
      facets({flat(0, 0.2, 0.2, 0.2), {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}, {Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}});
  const RayScene rays(scene);
  CHECK(rays.stacked_pairs() == 2);
  CHECK(rays.first_hit({0.25, 0.26, 1}, {0, 0, -1}).facet == 2);  // rows decide: the ground has the higher row here
  CHECK(rays.first_hit({0.25, 0.26, -1}, {0, 0, 1}).facet == 0);
  CHECK(rays.first_hit({0.7, 0.3, -1}, {0, 0, 1}).facet == 1);
  CHECK_FALSE(rays.occluded({0.7, 0.3, 0}, {0, 0, 1}, 1));
}

TEST_CASE("planes that differ in double precision keep their order") {
  const double gap = 1e-10;  // far below the spacing of floats
  const auto scene = facets({flat(gap), flat(0)});
  const RayScene rays(scene);
  CHECK(rays.first_hit({0.2, 0.2, 1}, {0, 0, -1}).facet == 0);
  CHECK(rays.first_hit({0.2, 0.2, -1}, {0, 0, 1}).facet == 1);
}

TEST_CASE("many facets in one plane and many in all planes: every stacked pair is found once") {
  std::vector<Triangle> t;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) t.push_back(flat(0, i, j));  // neighbours touch, none overlap
  for (const auto& leaf : leaves(20000, 30, 0.5, 7)) t.push_back(leaf);
  t.push_back(t[17]);
  t.push_back(t[5000]);
  const auto scene = facets(t);
  CHECK(RayScene(scene).stacked_pairs() == 2);
}

TEST_CASE("the answers do not depend on scale and offset") {
  const auto base = leaves(300, 1, 0.3, 11);
  const auto scene = facets(base);
  const RayScene rays(scene);
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double offset : {0.0, 1e6}) {
      std::vector<Triangle> moved = base;
      for (auto& t : moved)
        for (auto& p : t) p = scale * (p + Vec3{offset, -offset, offset});
      const auto other = facets(moved);
      const RayScene again(other);
      RandomStream random(13);
      int differ = 0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 p{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5}, d = direction(random);
        differ += rays.first_hit(p, d).facet != again.first_hit(scale * (p + Vec3{offset, -offset, offset}), d).facet;
      }
      CHECK(differ <= 1);  // a ray may graze an edge within the rounding of the moved coordinates
    }
}

TEST_CASE("a ray from afar is as exact as one from nearby") {
  const auto scene = facets(leaves(300, 1, 0.3, 11));
  const RayScene rays(scene);
  RandomStream random(17);
  int differ = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5}, d = direction(random);
    const auto near = rays.first_hit(p - 2.0 * d, d), far = rays.first_hit(p - 1e6 * d, d);
    differ += near.facet != far.facet;
  }
  CHECK(differ <= 1);
}

TEST_CASE("periodic: a cell meets what many copies of it would show") {
  const auto base = leaves(60, 1, 0.5, 19);  // some cross the borders of the cell
  const PeriodicCell cell{-0.4, -0.3, 0.5, 0.6};
  const auto periodic = facets(base, cell);
  const RayScene rays(periodic);
  constexpr int reach = 12;
  std::vector<Triangle> copies;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (auto t : base) {
        for (auto& p : t) p += Vec3{i * cell.width(), j * cell.depth(), 0};
        copies.push_back(t);
      }
  const auto written_out = facets(copies);
  const RayScene all(written_out);
  RandomStream random(23);
  int differ = 0, met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p{2 * random.next() - 1, 2 * random.next() - 1, random.next() - 0.5};
    Vec3 d = direction(random);
    if (std::abs(d.z) < 0.2) continue;
    const auto a = rays.first_hit(p, d), b = all.first_hit(p, d);
    met += static_cast<bool>(b);
    if (!b)
      differ += static_cast<bool>(a);
    else
      differ += !a || a.facet != b.facet % base.size() || a.front != b.front || std::abs(a.distance - b.distance) > 1e-4;
    REQUIRE(rays.occluded(p, d) == static_cast<bool>(a));
  }
  CHECK(met > 500);
  CHECK(differ <= 2);  // rays that graze an edge
}

TEST_CASE("periodic: level rays end, far cells are reached, a facet sees its own images") {
  // one upright leaf in a wide cell
  const auto scene = facets({{Vec3{0.5, 0.4, 0}, Vec3{0.5, 0.6, 0}, Vec3{0.5, 0.5, 1}}}, PeriodicCell{0, 0, 1, 1});
  const RayScene rays(scene);
  const Vec3 p{0.5, 0.5, 0.3};
  const auto hit = rays.first_hit(p, {1, 0, 0}, 0);
  REQUIRE(hit);
  CHECK(hit.distance == Approx(1).epsilon(1e-5));
  CHECK_FALSE(rays.occluded({0.5, 0.05, 0.3}, {0, 1, 0}));  // along the row, between the leaves, without end
  // a slope of 1 in 1000 meets the leaf 300 cells away, where the ray comes into the row's height
  const Vec3 far = glm::normalize(Vec3{1, 0, -1e-3});
  const auto late = rays.first_hit({0.7, 0.5, 1.2}, far);
  REQUIRE(late);
  CHECK(late.distance > 200);
}

TEST_CASE("periodic: a ground that fills the cell has no gaps, on borders neither") {
  const auto scene =
      facets({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}, {Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}}, PeriodicCell{0, 0, 1, 1});
  const RayScene rays(scene);
  RandomStream random(29);
  for (int i = 0; i < 20000; ++i) {
    Vec3 d = direction(random);
    d.z = -std::abs(d.z) - 0.001;
    d = glm::normalize(d);
    Vec3 p{10 * random.next() - 5, 10 * random.next() - 5, 1};
    if (i % 4 == 0) p.x = std::round(p.x), d = glm::normalize(Vec3{0, d.y, d.z});
    REQUIRE(rays.occluded(p, d));
  }
}

TEST_CASE("periodic: a leaf over very many cells is refused, with a reason") {
  const auto scene = facets({flat(0, 0, 0, 1e5)}, PeriodicCell{0, 0, 1, 1});
  CHECK_THROWS_WITH(RayScene(scene),
                    "domain.periodic: found facets that reach over more than 2000032 cells; expected a cell of about the plants' size, "
                    "all in metres");
  const auto far = facets({flat(0, 1e12)}, PeriodicCell{0, 0, 1, 1});
  CHECK_THROWS_AS(RayScene(far), InputError);
}
