#include <catch2/catch.hpp>

#include <algorithm>

#include <sunfleck/radiosity/elements.hpp>
#include <sunfleck/radiosity/solve.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;
using namespace reference_runs;

namespace {

Scene scene_of(std::vector<Mesh> meshes, std::size_t copies = 1) {
  auto scene = scene_with({"N"}, {{"leaf", {0.45f}, {0.45f}, {0.42f}}});
  sky(scene, SkyModel::uniform, 100);
  add(scene, "plant", std::move(meshes), 0);
  for (std::size_t c = 1; c < copies; ++c) scene.plants[0].placements.push_back({Affine::translate({3.0 * static_cast<double>(c), 0, 0})});
  return scene;
}

/// Leaves of a closed book, hinged at y = 0: three degrees between each and the next.
std::vector<Mesh> book() {
  std::vector<Mesh> pages;
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.052 * i;
    const Vec3 out{0, std::cos(angle), std::sin(angle)}, along{1, 0, 0};
    pages.push_back({{Vec3{0.0}, along, along + out, out}, {{0, 1, 2}, {0, 2, 3}}});
  }
  return pages;
}

}  // namespace

TEST_CASE("shades: where leaves meet, elements are parted by how bright they are; all copies alike", "[shades]") {
  RadiositySettings settings;
  settings.density.fewest_organs = 1.0;  // else one copy alone gets smaller elements
  const auto one = scene_of(book()), three = scene_of(book(), 3);
  const FacetScene facets = expand(one), more = expand(three);
  const auto e = make_elements(one, facets, settings), copies = make_elements(three, more, settings);
  settings.density.least_unevenness = 1e9;  // without shades
  const auto plain = make_elements(one, facets, settings);
  CHECK(e.size() > 2 * plain.size());
  CHECK(copies.size() == 3 * e.size());
  CHECK(e.surface.cells() > plain.surface.cells());
  // nothing is lost: every cell has an element, and areas add up
  double area = 0, before = 0;
  for (const auto a : e.area) area += a;
  for (const auto a : plain.area) before += a;
  CHECK(area == Approx(before).epsilon(1e-5));
  CHECK(*std::max_element(e.element_of_cell.begin(), e.element_of_cell.end()) + 1 == e.size());
  CHECK(e.first_cell.back() == e.surface.cells());
  // cells send out as bright as they are, elements as much as without: 32 is the mean by area
  REQUIRE(e.emission.size() == 2 * e.surface.cells());
  CHECK(plain.emission.empty());
  CHECK(*std::min_element(e.emission.begin(), e.emission.end()) < 24);
  for (std::size_t side = 0; side < 2; ++side) {
    double sent = 0, all = 0;
    for (std::size_t c = 0; c < e.surface.cells(); ++c) {
      sent += e.surface.cell_area[e.row_of_cell[c]] * e.emission[2 * c + side];
      all += 32.0 * e.surface.cell_area[e.row_of_cell[c]];
    }
    CHECK(sent == Approx(all).epsilon(0.01));
  }
}

TEST_CASE("shades: leaves apart from each other stay as they were", "[shades]") {
  RadiositySettings settings;
  const auto scene = scene_of(leaves(60, 0.1, {1.5, 1.5, 1}, 4));
  const FacetScene facets = expand(scene);
  const auto e = make_elements(scene, facets, settings);
  settings.density.least_unevenness = 1e9;
  CHECK(e.element_of_cell == make_elements(scene, facets, settings).element_of_cell);
}
