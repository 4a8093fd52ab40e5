// Facets of the ground cut in pieces.
#include <catch2/catch.hpp>

#include <sunfleck/core/sampling.hpp>
#include <sunfleck/visibility/ground_pieces.hpp>

using namespace sunfleck;

TEST_CASE("pieces cover their facet, are fine under plants, and every point finds its own", "[visibility]") {
  const Triangle facet{Vec3{0, 0, 1}, Vec3{100, 0, 1}, Vec3{100, 100, 1}};
  Box plant;
  plant.add(Vec3{60, 20, 1});
  plant.add(Vec3{61, 21, 2});
  const Footprints plants({plant, Box{}});
  CHECK(plants.distance(facet) == 0.0);
  CHECK(plants.area(1.0) == Approx(9.0));
  const auto pieces = cut_ground_facet(facet, plants, 0.25);
  double area = 0.0;
  GroundPieceIndex index;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const auto& c = pieces[i].corners;
    const Vec3 a = area_vector(c);
    area += a.z;
    CHECK(a.z > 0.0);
    CHECK(std::sqrt(2.0 * a.z) <= std::max(0.25, 0.5 * plants.distance(c)));
    index.add(7, pieces[i], i);
  }
  CHECK(area == Approx(5000.0));
  CHECK(pieces.size() < 2000);
  CHECK(index.knows(7));
  CHECK_FALSE(index.knows(8));
  RandomStream random(3);
  for (int k = 0; k < 2000; ++k) {
    double u = random.next(), v = random.next();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Vec3 point = facet[0] + u * (facet[1] - facet[0]) + v * (facet[2] - facet[0]);
    const auto& c = pieces[index.find(7, u, v)].corners;
    const Vec3 found = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
    CHECK(glm::length(found - point) < 1e-3);
  }
}
