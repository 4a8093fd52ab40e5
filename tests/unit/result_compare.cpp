#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/compare.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// One state, one band, black leaves: absorbed per area = E_f + E_b. Values per facet on the front, none on the back.
Scene black_scene() {
  Scene scene = small_scene();
  scene.states.resize(1);
  scene.bands = {"PAR"};
  scene.band_units = {"W m^-2"};
  scene.states[0].sun->irradiance = {400};
  scene.states[0].sky->irradiance = {100};
  for (auto& o : scene.optics) o = {o.name, {0}, {0}, {0}};
  scene.ground->optics = {"ground", {0}, {0}, {0}};
  return scene;
}

struct Made {
  std::vector<float> front;     ///< [n] W m^-2
  std::vector<float> variance;  ///< [n] or empty
  Balance balance{10, 6, 2, 2};
};

std::string write(const Folder& folder, const char* name, const Scene& scene, const Made& made, const OutputChoice& output = {}) {
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  std::vector<float> irradiance;
  for (const float e : made.front) irradiance.insert(irradiance.end(), {e, 0.0f});
  ResultWriter writer(folder / name, scene, placed, output, "0.1.0", made.variance.empty() ? "flat" : "reference");
  writer.rows({0, facets.size(), irradiance.data(), nullptr, made.variance.empty() ? nullptr : made.variance.data()});
  SolveReport report = small_report();
  report.balance = {{made.balance}};
  writer.finish(report);
  return folder / name;
}

}  // namespace

TEST_CASE("compare finds the bias, rmse and maximum that were put in", "[result][compare]") {
  const Folder folder;
  const Scene scene = black_scene();
  const FacetScene facets = expand(scene);
  const std::size_t n = facets.size();
  Made reference{std::vector<float>(n, 100.0f), {}};

  SECTION("a constant shift is a bias; ground cells do not count") {
    Made shifted = reference;
    for (std::size_t f = 0; f < n; ++f) shifted.front[f] = f < facets.plant_facets ? 103.0f : 1000.0f;
    const auto c = compare(Result(write(folder, "x.h5", scene, shifted)), Result(write(folder, "r.h5", scene, reference)));
    for (const auto* table : {&c.organs, &c.facets}) {
      const auto& e = table->overall[0];
      CHECK(e.mean == Approx(100.0));
      CHECK(e.bias == Approx(0.03).epsilon(1e-6));
      CHECK(e.rmse == Approx(0.03).epsilon(1e-6));
      CHECK(e.maximum == Approx(0.03).epsilon(1e-6));
      CHECK(e.noise == 0.0);
      CHECK_FALSE(e.irradiance);
    }
    CHECK(c.facets.overall[0].count == facets.plant_facets);
    CHECK(c.organs.overall[0].count == 16);  // four copies of a stem and three leaves
  }
  SECTION("errors are weighted by area") {
    Made one_off = reference;
    one_off.front[1] = 150.0f;
    const auto c = compare(Result(write(folder, "x.h5", scene, one_off)), Result(write(folder, "r.h5", scene, reference)));
    double area = 0, organ_area = 0;
    for (std::size_t f = 0; f < facets.plant_facets; ++f) area += facets.area[f];
    for (std::size_t f = 0; f < facets.plant_facets; ++f) organ_area += facets.organ[f] == facets.organ[1] ? facets.area[f] : 0.0f;
    const double w = facets.area[1] / area, share = facets.area[1] / organ_area;
    CHECK(c.facets.overall[0].bias == Approx(0.5 * w).epsilon(1e-5));
    CHECK(c.facets.overall[0].rmse == Approx(0.5 * std::sqrt(w)).epsilon(1e-5));
    CHECK(c.facets.overall[0].maximum == Approx(0.5).epsilon(1e-6));
    CHECK(c.organs.overall[0].bias == Approx(0.5 * w).epsilon(1e-5));
    CHECK(c.organs.overall[0].rmse == Approx(0.5 * share * std::sqrt(organ_area / area)).epsilon(1e-5));
  }
  SECTION("the noise of the reference is taken out, and never below zero") {
    Made wrong = reference;
    for (auto& e : wrong.front) e = 105.0f;
    Made noisy = reference;
    noisy.variance.assign(n, 16.0f);  // (4 W m^-2)^2
    // Facets are independent: an organ's variance is the sum of area^2 x variance, here 16 W^2 m^-4 each.
    std::vector<double> area(facets.organs.size(), 0.0), squares(facets.organs.size(), 0.0);
    double sum = 0.0, noise = 0.0;
    for (std::size_t f = 0; f < facets.plant_facets; ++f) {
      area[facets.organ[f]] += facets.area[f];
      squares[facets.organ[f]] += double{facets.area[f]} * facets.area[f];
    }
    for (std::size_t o = 0; o < area.size(); ++o)
      if (area[o] > 0) sum += area[o], noise += 16.0 * squares[o] / area[o];
    noise /= sum;
    REQUIRE(noise < 16.0);
    const auto c = compare(Result(write(folder, "x.h5", scene, wrong)), Result(write(folder, "r.h5", scene, noisy)));
    CHECK(c.facets.overall[0].rmse == Approx(0.03).epsilon(1e-5));  // sqrt(25 - 16) = 3
    CHECK(c.facets.overall[0].noise == Approx(0.04).epsilon(1e-5));
    CHECK(c.organs.overall[0].rmse == Approx(0.01 * std::sqrt(25.0 - noise)).epsilon(1e-5));
    CHECK(c.organs.overall[0].noise == Approx(0.01 * std::sqrt(noise)).epsilon(1e-5));
    CHECK(c.organs.overall[0].bias == Approx(0.05).epsilon(1e-5));
    Made noisier = noisy;
    noisier.variance.assign(n, 100.0f);
    CHECK(compare(Result(folder / "x.h5"), Result(write(folder, "n.h5", scene, noisier))).organs.overall[0].rmse == 0.0);
    // The noise of both files, where both are references.
    const auto both = compare(Result(folder / "r.h5"), Result(folder / "r.h5"));
    CHECK(both.facets.overall[0].noise == Approx(0.04 * std::sqrt(2.0)).epsilon(1e-5));
  }
  SECTION("irradiance takes the place of absorbed where nothing is absorbed") {
    Scene white = scene;
    for (auto& o : white.optics) o.reflectance_front = o.reflectance_back = {1.0f};
    Made shifted = reference;
    for (auto& e : shifted.front) e = 98.0f;
    shifted.balance = reference.balance = {10, 1e-9, 2, 8};
    const auto c = compare(Result(write(folder, "x.h5", white, shifted)), Result(write(folder, "r.h5", white, reference)));
    CHECK(c.organs.overall[0].irradiance);
    CHECK(c.organs.overall[0].mean == Approx(100.0));
    CHECK(c.organs.overall[0].bias == Approx(-0.02).epsilon(1e-5));
    CHECK(c.facets.states[0][0].rmse == Approx(0.02).epsilon(1e-5));
  }
}

TEST_CASE("compare counts each state and all together", "[result][compare]") {
  const Folder folder;
  Scene scene = black_scene();
  scene.states.push_back(scene.states[0]);
  scene.states[1].name = "evening";
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const std::size_t n = facets.size();
  const auto write_states = [&](const char* name, float noon, float evening) {
    std::vector<float> irradiance(2 * n * 2, 0.0f);
    for (std::size_t f = 0; f < n; ++f) irradiance[2 * f] = noon, irradiance[2 * n + 2 * f] = evening;
    ResultWriter writer(folder / name, scene, placed, OutputChoice{}, "0.1.0", "flat");
    writer.rows({0, n, irradiance.data(), nullptr, nullptr});
    SolveReport report = small_report();
    report.balance = {{Balance{10, 5, 0, 5}}, {Balance{2, 1, 0, 1}}};
    writer.finish(report);
    return Result(folder / name);
  };
  const auto c = compare(write_states("x.h5", 102, 19), write_states("r.h5", 100, 20));
  CHECK(c.organs.states[0][0].bias == Approx(0.02).epsilon(1e-5));
  CHECK(c.organs.states[1][0].bias == Approx(-0.05).epsilon(1e-5));
  CHECK(c.organs.overall[0].bias == Approx(0.5 / 60).epsilon(1e-5));  // (2 - 1) / 2 over (100 + 20) / 2
  CHECK(c.organs.overall[0].rmse == Approx(std::sqrt((4.0 + 1.0) / 2) / 60).epsilon(1e-5));
}

TEST_CASE("compare refuses results of different scenes and says what differs", "[result][compare]") {
  const Folder folder;
  const Scene scene = black_scene();
  const std::string r = write(folder, "r.h5", scene, {std::vector<float>(expand(scene).size(), 1.0f), {}});
  const auto against = [&](const Scene& other) {
    const std::string x = write(folder, "x.h5", other, {std::vector<float>(expand(other).size(), 1.0f), {}});
    compare(Result(x), Result(r));
  };
  const std::string x = folder / "x.h5", why = " as in " + r + "; only results of the same scene can be compared";
  Scene other = scene;
  SECTION("bands") {
    other.bands = {"NIR"};
    CHECK_THROWS_WITH(against(other), x + ": found bands NIR; expected bands PAR" + why);
  }
  SECTION("organs") {
    other.plants[0].placements.pop_back();
    CHECK_THROWS_WITH(against(other), x + ": found 18 organs; expected 22" + why);
  }
  SECTION("areas") {
    other.plants[0].placements[0].map = Affine::scale(2.0);
    CHECK_THROWS_WITH(against(other), Catch::Contains("found organ 0 with an area of") && Catch::Contains(why));
  }
}

TEST_CASE("results of scenes that only look alike are refused: one organ lies, faces or repeats otherwise", "[result][compare]") {
  const Folder folder;
  const Scene scene = black_scene();
  const std::string r = write(folder, "r.h5", scene, {std::vector<float>(expand(scene).size(), 1.0f), {}});
  const std::string x = folder / "x.h5", why = " as in " + r + "; only results of the same scene can be compared";
  const auto written = [&](const Scene& other) {
    return Result(write(folder, "x.h5", other, {std::vector<float>(expand(other).size(), 1.0f), {}}));
  };
  Scene other = scene;
  SECTION("a plant is moved by a centimetre") {
    other.plants[0].placements[1].map.translation.x += 0.01;
    CHECK_THROWS_WITH(compare(written(other), Result(r)),
                      Catch::StartsWith(x + ": found facet ") && Catch::Contains(" at (") && Catch::EndsWith(why));
    CHECK(compare(written(other), Result(r), false).organs.overall[0].rmse == 0.0);
  }
  SECTION("a plant is turned about itself") {
    other.plants[0].placements[1].map = other.plants[0].placements[1].map * Affine::turn(0.01);
    CHECK_THROWS_WITH(compare(written(other), Result(r)), Catch::Contains(": found facet ") && Catch::EndsWith(why));
  }
  SECTION("a facet faces elsewhere with its centroid where it was") {
    auto plant = std::make_shared<Plant>(*scene.plants[0].plant);
    auto& corners = plant->meshes[0].vertices;
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (auto& p : corners) p = middle + Vec3{p.x - middle.x, p.z - middle.z, middle.y - p.y};  // a quarter about x
    other.plants[0].plant = plant;
    CHECK_THROWS_WITH(compare(written(other), Result(r)),
                      Catch::StartsWith(x + ": found facet 0 of 0.0166667 m^2 that faces (") && Catch::EndsWith(why));
  }
  SECTION("the ground is higher") {
    other.ground->height = -0.05;
    CHECK_THROWS_WITH(compare(written(other), Result(r)), Catch::Contains(": found facet ") && Catch::EndsWith(why));
  }
  SECTION("one repeats") {
    other.periodic = PeriodicCell{-10, -10, 10, 10};
    CHECK_THROWS_WITH(compare(written(other), Result(r)),
                      x + ": found a cell from (-10, -10) to (10, 10) that repeats; expected nothing that repeats" + why);
  }
  SECTION("without meshes, by centroids") {
    const OutputChoice few{true, {"facets/absorbed", "facets/area", "facets/centroid", "facets/organ", "organs/absorbed"}};
    other.plants[0].placements[1].map.translation.x += 0.01;
    const std::string k = write(folder, "k.h5", scene, {std::vector<float>(expand(scene).size(), 1.0f), {}}, few);
    CHECK_THROWS_WITH(compare(written(other), Result(k)), Catch::Contains(": found facet "));
    CHECK(compare(Result(k), Result(r)).notes.empty());
  }
}

TEST_CASE("light, optics and names that differ are said, and what is rounded is not", "[result][compare]") {
  const Folder folder;
  const Scene scene = black_scene();
  const std::string r = write(folder, "r.h5", scene, {std::vector<float>(expand(scene).size(), 1.0f), {}});
  const auto notes = [&](const Scene& other) {
    return compare(Result(write(folder, "x.h5", other, {std::vector<float>(expand(other).size(), 1.0f), {}})), Result(r)).notes;
  };
  CHECK(notes(scene).empty());
  Scene other = scene;
  other.plants[0].placements[1].map.translation.x += 1e-9;
  CHECK(notes(other).empty());
  other = scene;
  other.states[0].sun->irradiance[0] = 500;
  CHECK(notes(other) == std::vector<std::string>{"their light differs: sun"});
  other.states[0].sky->model = SkyModel::standard_overcast;
  CHECK(notes(other) == std::vector<std::string>{"their light differs: sun, sky"});
  other = scene;
  other.states[0].name = "morning";
  CHECK(notes(other) == std::vector<std::string>{"their light differs: name of state 1 ('morning' and 'noon')"});
  other = scene;
  other.optics[0].reflectance_back = {0.5f};
  CHECK(notes(other) == std::vector<std::string>{"their optics differ: leaf"});
  other = scene;
  other.plants[0].name = "bush";
  CHECK(notes(other) == std::vector<std::string>{"their organs are named otherwise: organ 0 has the plant 'bush' and 'shrub'"});
}
