// Rays through copies that are not written out, against rays through the same scene written out.
#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/sampling.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/view/placed_rays.hpp>
#include <sunfleck/view/stored.hpp>
#include <sunfleck/visibility/rays.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

Result store(const Folder& folder, const Scene& scene) {
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
  return Result(folder / "r.h5");
}

struct Ray {
  Vec3 origin, direction;
};

/// From points around the box towards points in it.
std::vector<Ray> rays_through(const Box& box, int count) {
  RandomStream random(7);
  std::vector<Ray> out;
  for (int i = 0; i < count; ++i) {
    Vec3 from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = box.centre()[k] + 2 * box.size()[k] * (random.next() - 0.5);
      to[k] = box.low[k] + box.size()[k] * random.next();
    }
    from.z += box.size().z;
    out.push_back({from, glm::normalize(to - from)});
  }
  return out;
}

}  // namespace

TEST_CASE("rays meet the same facets in trees of trees as in one tree", "[view]") {
  const Folder folder;
  const Scene scene = small_scene(40);  // mirrored, scaled and grouped copies; leaves share a mesh
  const Result result = store(folder, scene);
  const FacetScene flat = stored_scene(result);
  const DrawnScene drawn(result);
  const RayScene reference(flat);
  const std::size_t written_out =
      GENERATE(std::size_t{PlacedRays::most_written_out}, std::size_t{0});  // whole plants, or leaves as copies in plants
  const PlacedRays placed(drawn, written_out);
  int hits = 0, different = 0;
  const auto rays = rays_through(flat.bounds, 20000);
  for (const auto& [origin, direction] : rays) {
    const auto a = reference.first_hit(origin, direction);
    const auto b = placed.first_hit(origin, direction);
    hits += a.facet != no_facet;
    if ((a.facet == no_facet) != !b || (b && a.facet != b.facet)) {
      ++different;
      continue;
    }
    REQUIRE(placed.occluded(origin, direction) == static_cast<bool>(b));
    if (!b) continue;
    // Both keep single precision of coordinates of a few metres: 1e-6 m, more along the ray where the facet is seen at a slant.
    const auto at = placed.surface(b, direction);
    const auto& c = flat.corners[a.facet];
    const auto point = [&](double u, double v) { return (1 - u - v) * c[0] + u * c[1] + v * c[2]; };
    REQUIRE(at.corners == c);
    REQUIRE(at.front == a.front);
    const double slant = std::fabs(glm::dot(at.normal, direction));
    REQUIRE(glm::length(point(at.u, at.v) - point(a.u, a.v)) < 2e-5 / slant);
    REQUIRE(b.distance == Approx(a.distance).margin(2e-5 / slant));
    // A ray that starts on the facet does not meet it again.
    const auto next =
        placed.first_hit(point(at.u, at.v), direction, PlacedRays::Part::all, 0, std::numeric_limits<double>::infinity(), b.facet);
    REQUIRE((!next || next.facet != b.facet));
  }
  REQUIRE(hits > 3000);
  REQUIRE(different <= hits / 500);  // rays past an edge, within single precision
  REQUIRE(placed.bytes() > 0);
}

TEST_CASE("rays through a periodic scene that is not written out go through all its images", "[view]") {
  const Folder folder;
  Scene scene = small_scene(12);
  scene.periodic = PeriodicCell{-2, -1.5, 2, 1.5};  // copies stand outside of it and reach across its borders
  const Result result = store(folder, scene);
  const FacetScene flat = stored_scene(result);
  const DrawnScene drawn(result, false);
  const FacetScene plants = stored_scene(result, false);
  const RayScene reference(plants);
  const PlacedRays placed(drawn);
  int hits = 0, different = 0;
  for (const auto& [origin, direction] : rays_through(flat.bounds, 20000)) {
    const Vec3 d = glm::normalize(Vec3{direction.x, direction.y, -std::fabs(direction.z) - 0.02});
    const auto a = reference.first_hit(origin, d);
    const auto b = placed.first_hit(origin, d, PlacedRays::Part::repeated);
    hits += a.facet != no_facet;
    // Copies wrapped into one cell may lie on each other: which is met is then open, how far is not.
    different += (a.facet == no_facet) != !b || (b && std::fabs(b.distance - a.distance) > 1e-4);
    REQUIRE(placed.occluded(origin, d, PlacedRays::Part::repeated) == static_cast<bool>(b));
  }
  REQUIRE(hits > 2000);
  REQUIRE(different <= hits / 200);  // rays past an edge, within single precision
}

TEST_CASE("a query for the ground alone passes through plants; rays that are not finite are refused", "[view]") {
  const Folder folder;
  const Result result = store(folder, small_scene(3));
  const DrawnScene drawn(result);
  const PlacedRays placed(drawn);
  const auto ground = placed.first_hit({0, 0, 3}, {0, 0, -1}, PlacedRays::Part::ground);
  REQUIRE(ground);
  REQUIRE(ground.facet >= drawn.plant_facets());
  REQUIRE(ground.distance == Approx(3));
  const DrawnScene plants(result, false);
  REQUIRE_FALSE(PlacedRays(plants).first_hit({0, 0, 3}, {0, 0, -1}, PlacedRays::Part::ground));
  REQUIRE_THROWS_WITH(placed.first_hit({0, 0, NAN}, {0, 0, -1}), "a ray whose origin or direction is not finite");
}
