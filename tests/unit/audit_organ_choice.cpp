// Which organs a certificate looks at.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <vector>

#include <sunfleck/audit/certificate.hpp>

#include "reference_runs.hpp"

using namespace sunfleck;

TEST_CASE("organs to check do not repeat with the copies of a stand") {
  auto scene = reference_runs::scene_with({"PAR"}, {uniform_optics("leaf", {0.1}, {0.1})});
  reference_runs::add(scene, "tree", reference_runs::leaves(100, 0.1, {1, 1, 1}, 3), 0);
  scene.plants[0].placements.clear();
  for (int i = 0; i < 300; ++i) {
    Affine map;
    map.translation = {2.0 * i, 0, 0};
    scene.plants[0].placements.push_back({map});
  }
  const PlacedScene placed = place(scene);
  CertificateSettings settings;
  settings.organs = 500;  // one in 3/5 of a tree
  const auto chosen = choose_organs(FacetRows(scene, placed), settings);
  CHECK(chosen.size() == 500);
  std::set<std::uint64_t> leaves, trees;
  double share = 0;
  for (const auto& c : chosen) leaves.insert(c.organ % 100), trees.insert(c.organ / 100), share += c.share;
  CHECK(leaves.size() > 95);  // 100 (1 - 1 / e^5) = 99 are expected
  CHECK(trees.size() == 300);
  CHECK(share == Approx(1));
}

TEST_CASE("organs to check are drawn as often as their size asks, and none twice") {
  auto scene = reference_runs::scene_with({"PAR"}, {uniform_optics("leaf", {0.1}, {0.1})});
  constexpr int organs = 24, wanted = 10, runs = 4000;
  std::vector<Mesh> meshes;
  for (int i = 0; i < organs; ++i) meshes.push_back(reference_runs::square(i, 0.5 + 0.03 * ((7 * i) % organs)));
  reference_runs::add(scene, "leaves", std::move(meshes), 0);
  const PlacedScene placed = place(scene);
  const FacetRows rows(scene, placed);
  std::vector<double> drawn(organs, 0.0), area(organs);
  double mean = 0;
  for (int i = 0; i < organs; ++i) {
    area[i] = std::pow(0.5 + 0.03 * ((7 * i) % organs), 2);
    mean += area[i] / organs;
  }
  for (int run = 0; run < runs; ++run) {
    CertificateSettings settings;
    settings.organs = wanted;
    settings.seed = static_cast<std::uint64_t>(run);
    const auto chosen = choose_organs(rows, settings);
    REQUIRE(chosen.size() == wanted);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (k > 0) REQUIRE(chosen[k - 1].organ < chosen[k].organ);
      drawn[chosen[k].organ] += 1.0 / runs;
    }
  }
  double worst = 0;
  for (int i = 0; i < organs; ++i) {
    const double probability = wanted * (area[i] + 3 * mean) / (4 * mean * organs);
    worst = std::max(worst, std::fabs(drawn[i] - probability) / std::sqrt(probability * (1 - probability) / runs));
  }
  CHECK(worst < 4);  // standard errors, of 24
}
