#include <catch2/catch.hpp>

#include "result_scene.hpp"
#include "view/organ_patches.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, up{0, 0, 1};

void same_corners(const OrganPatch& patch, const std::vector<Triangle>& corners) {
  REQUIRE(patch.triangles.size() == corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) CHECK(patch.vertices[patch.triangles[t][k]] == corners[t][k]);
}

std::vector<std::uint32_t> star(const OrganPatch& patch, std::size_t vertex) {
  return {patch.star.begin() + patch.star_first[vertex], patch.star.begin() + patch.star_first[vertex + 1]};
}

}  // namespace

TEST_CASE("Facets of one organ share vertices, those of two do not", "[view][export]") {
  const std::vector<Triangle> corners{{a, b, c}, {a, c, d}};
  const auto one = make_patch(corners, {7, 7});
  same_corners(one, corners);
  CHECK(one.vertices.size() == 4);
  CHECK(star(one, one.triangles[0][0]) == std::vector<std::uint32_t>{0, 1});
  CHECK(star(one, one.triangles[0][1]) == std::vector<std::uint32_t>{0});
  const auto two = make_patch(corners, {7, 8});
  same_corners(two, corners);
  CHECK(two.vertices.size() == 6);
}

TEST_CASE("Coordinates that differ in the sign of zero are the same place", "[view][export]") {
  const auto patch = make_patch({{a, b, c}, {Vec3{-0.0, 0, -0.0}, c, d}}, {0, 0});
  CHECK(patch.vertices.size() == 4);
}

TEST_CASE("What is not manifold keeps every facet and its corners", "[view][export]") {
  SECTION("a third facet at an edge") {
    const std::vector<Triangle> corners{{a, b, c}, {a, c, d}, {c, a, up}};
    const auto patch = make_patch(corners, {0, 0, 0});
    same_corners(patch, corners);
    CHECK(patch.vertices.size() == 4 + 3);
    CHECK(star(patch, patch.triangles[2][0]) == std::vector<std::uint32_t>{2});
  }
  SECTION("a neighbour with its front on the other side") {
    const std::vector<Triangle> corners{{a, b, c}, {a, d, c}};
    const auto patch = make_patch(corners, {0, 0});
    same_corners(patch, corners);
    CHECK(patch.vertices.size() == 6);
  }
  SECTION("facets that only touch at a corner") {
    const std::vector<Triangle> corners{{a, b, c}, {a, Vec3{-1, 0, 0}, Vec3{-1, -1, 0}}};
    const auto patch = make_patch(corners, {0, 0});
    same_corners(patch, corners);
    CHECK(patch.vertices.size() == 5);
    CHECK(star(patch, patch.triangles[0][0]) == std::vector<std::uint32_t>{0, 1});
  }
  SECTION("corners that coincide") {
    const std::vector<Triangle> corners{{a, a, c}, {a, b, c}, {b, b, b}};
    const auto patch = make_patch(corners, {0, 0, 0});
    same_corners(patch, corners);
    CHECK(patch.vertices.size() == 9);  // those of the second, and three for each of the others
  }
  SECTION("the same facet twice") {
    const std::vector<Triangle> corners{{a, b, c}, {a, b, c}};
    const auto patch = make_patch(corners, {0, 0});
    same_corners(patch, corners);
    CHECK(patch.vertices.size() == 6);
  }
}

TEST_CASE("Values at vertices are area-weighted means over the facets about them", "[view][export]") {
  const auto patch = make_patch({{a, b, c}, {a, c, d}}, {0, 0});
  const float values[] = {1, 10, 4, 40};
  const float area[] = {3, 1};
  const auto means = patch.vertex_means(values, 2, area);
  const auto at = [&](std::size_t t, std::size_t k) { return 2 * patch.triangles[t][k]; };
  CHECK(means[at(0, 1)] == 1.0f);
  CHECK(means[at(1, 2) + 1] == 40.0f);
  CHECK(means[at(0, 0)] == 1.75f);
  CHECK(means[at(0, 2) + 1] == 17.5f);
  const float none[] = {0, 0};
  CHECK(patch.vertex_means(values, 2, none)[at(0, 0)] == 2.5f);
}

TEST_CASE("Patches of a scene follow the facets, whole organs even where their shapes lie apart", "[view][export]") {
  // organ 1 owns the first and the third triangle, organ 2 the second
  auto plant = std::make_shared<Plant>();
  plant->types = {"plant", "leaf"};
  plant->materials = {""};
  plant->structures = {{no_parent, 0, "", {}, {}}, {0, 1, "", {}, {}}, {0, 1, "", {}, {}}};
  plant->meshes = {{{a, b, c, d}, {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}}};
  for (std::uint32_t t = 0; t < 3; ++t) plant->shapes.push_back({t == 1 ? 2u : 1u, 0, t, 1, 0, {}});
  ResultGeometry geometry;
  geometry.plants.push_back({"p", plant, {0, 0, 0}, {0, 1, 2, 3}});
  const Affine mirror{Mat3{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, Vec3{0.0}};
  geometry.copies = {{0, Affine::translate({5, 0, 0}), 0}, {0, mirror, 3}};
  geometry.ground = {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
  geometry.plant_facets = 6;
  const OrganPatches patches(geometry, {9, 9});
  CHECK(patches.plant_vertices(0) == 4 + 3);
  CHECK(patches.ground_vertices() == 4);
  CHECK(patches.vertex_count() == 2 * 7 + 4);
  std::size_t facets = 0, batches = 0, vertices = 0;
  patches.for_each_batch(4, [&](std::span<const PlacedPatch> batch) {
    ++batches;
    for (const auto& placed : batch) {
      CHECK(placed.first_facet == facets);
      CHECK(placed.first_vertex == vertices);
      const auto corners = geometry.corners(facets, placed.facets());
      for (std::size_t t = 0; t < placed.facets(); ++t)
        for (std::size_t k = 0; k < 3; ++k) CHECK(placed.map.point(placed.patch->vertices[placed.triangle(t)[k]]) == corners[t][k]);
      facets += placed.facets();
      vertices += placed.patch->vertices.size();
    }
  });
  CHECK(facets == 8);
  CHECK(batches == 2);
  CHECK(vertices == patches.vertex_count());
}
