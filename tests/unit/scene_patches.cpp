#include <catch2/catch.hpp>

#include <cmath>

#include <sunfleck/scene/patches.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

/// A strip of squares, two triangles each, that folds by an angle from each to the next.
std::vector<Triangle> strip(int squares, double fold_degrees) {
  std::vector<Triangle> out;
  Vec3 at{0.0};
  for (int i = 0; i < squares; ++i) {
    const double angle = i * fold_degrees * M_PI / 180.0;
    const Vec3 next = at + Vec3{std::cos(angle), 0.0, std::sin(angle)}, y{0, 1, 0};
    out.push_back({at, next, next + y});
    out.push_back({at, next + y, at + y});
    at = next;
  }
  return out;
}

std::vector<std::uint32_t> patches_of(const std::vector<Triangle>& corners) {
  return patches_of_plant(corners, std::vector<std::uint32_t>(corners.size(), 0));
}

/// One mesh, each triangle with corners of its own.
Mesh soup_of(const std::vector<Triangle>& corners) {
  Mesh mesh;
  for (const auto& t : corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& p : t) mesh.vertices.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace

TEST_CASE("patches: facets joined by edges that fold little, corners by coordinates", "[patches]") {
  using Numbers = std::vector<std::uint32_t>;
  CHECK(patches_of(strip(3, 0)) == Numbers(6, 0));
  CHECK(patches_of(strip(3, 90)) == Numbers(6, 0));
  CHECK(patches_of(strip(3, 130)) == Numbers{0, 0, 1, 1, 2, 2});
  auto apart = strip(2, 0);
  for (auto& p : apart[2]) p += Vec3{1e-9, 0, 0};  // what rounding does
  for (auto& p : apart[3]) p += Vec3{1e-9, 0, 0};
  CHECK(patches_of(apart) == Numbers(4, 0));
  for (auto& p : apart[2]) p += Vec3{0.01, 0, 0};
  for (auto& p : apart[3]) p += Vec3{0.01, 0, 0};
  CHECK(patches_of(apart) == Numbers{0, 0, 1, 1});
  const auto two = strip(2, 0);
  CHECK(patches_of_plant(two, Numbers{0, 0, 1, 1}) == Numbers{0, 0, 1, 1});  // materials
  // a corner in common joins nothing, nor does an edge of no length; far from the origin it is the same
  const std::vector<Triangle> fan{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}},
                                  {Vec3{0, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}},
                                  {Vec3{0, 0, 0}, Vec3{0, 0, 0}, Vec3{-1, 0, 0}}};
  CHECK(patches_of(fan)[0] != patches_of(fan)[1]);
  auto far = strip(4, 20);
  for (auto& t : far)
    for (auto& p : t) p += Vec3{1e6, -1e6, 10};
  CHECK(patches_of(far) == Numbers(8, 0));
  CHECK(patches_of({}).empty());
}

TEST_CASE("patches: copies have those of their plant, each its own; the ground's are its organs", "[patches]") {
  auto scene = scene_with({"N"}, {{"leaf", {0.45f}, {0.45f}, {0.42f}}});
  sky(scene, SkyModel::uniform, 100);
  auto beside = strip(2, 130);
  for (auto& t : beside)
    for (auto& p : t) p += Vec3{0, 3, 0};
  add(scene, "plant", {soup_of(strip(3, 10)), soup_of(beside)}, 0);
  scene.plants[0].placements.push_back({Affine::translate({10, 0, 0})});
  scene.ground = flat_ground({4, 4}, {0, 0}, {3, 2}, {0.1});
  const auto facets = expand(scene);
  const auto patches = find_patches(facets);
  REQUIRE(patches.size() == 2 * 3 + 6);
  CHECK(patches.end_of_copy == std::vector<std::uint32_t>{3, 6});
  CHECK(patches.of_facet[0] == 0);
  CHECK(patches.of_facet[6] == 1);
  CHECK(patches.of_facet[8] == 2);
  CHECK(patches.of_facet[10] == 3);
  CHECK(patches.of_facet.back() == 11);
  CHECK(patches.structure[4] == facets.organs.structure[facets.organ[16]]);
}

TEST_CASE("patches: small ones count by what they are of the middle one", "[patches]") {
  const auto even = patch_areas({2.0, 2.0, 0.0, 2.0});
  CHECK(even.sum == 6.0);
  CHECK(even.count == 3.0);
  CHECK(even.middle == 2.0);
  std::vector<double> ear(10, 1.0);
  ear.insert(ear.end(), 40, 0.01);  // a twentieth of a fifth of 1: roots 10 against 4
  const auto mixed = patch_areas(ear);
  CHECK(mixed.count == Approx(10.0 + 40.0 * 0.05));
  CHECK(mixed.middle == 1.0);
  CHECK(patch_areas({}).count == 0.0);
  CHECK(patch_areas({0.0, 0.0}).sum == 0.0);
}
