#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/result_reader.hpp>

#include <sunfleck/core/sha256.hpp>
#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// Largest distance of two lists of corners [m]. Maps may be contracted to fused multiply-adds in one place and not in the other.
double distance(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
  if (a.size() != b.size()) return 1e9;
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, glm::length(a[i][c] - b[i][c]));
  return worst;
}
constexpr double rounding = 1e-12;  // 2^-53 of scenes some hundred metres wide, a few roundings

}  // namespace

TEST_CASE("SHA-256 gives the digests of FIPS 180-4", "[result]") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST_CASE("A result file gives back what was written", "[result]") {
  const Folder folder;
  // The larger scene needs several chunks per dataset; the smaller is stored in one piece.
  const auto leaves = GENERATE(3u, 6000u);
  const auto piece = GENERATE(std::size_t{7}, std::size_t{1} << 20);
  if (leaves > 3 && piece == 7) return;
  const Scene scene = small_scene(leaves);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  const std::string file = folder / "r.h5";
  {
    ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
    values.send(writer, piece);
    Certificate c;
    c.organs = {1, 3};
    c.solved = {1, 2, 3, 4, 5, 6, 7, 8};
    c.reference = {1.5f, 2, 3, 4, 5, 6, 7, 8};
    c.standard_error.assign(8, 0.125f);
    c.rmse = {0.01, 0.02}, c.rmse_low = {0.005, 0.01}, c.rmse_high = {0.02, 0.03}, c.bias = {-0.001, 0.002};
    c.rays = 12345, c.seed = 9;
    CHECK_FALSE(std::filesystem::exists(file));
    writer.finish(small_report(), &c);
  }
  CHECK(folder.files() == 1);

  const Result result(file);
  CHECK(result.header().method == "flat");
  CHECK(result.header().status == "converged");
  CHECK(result.header().scene_text == scene.text);
  CHECK(result.header().scene_sha256 == sha256_hex(scene.text));
  CHECK(result.bands() == scene.bands);
  REQUIRE(result.states().size() == 2);
  CHECK(result.states()[0].name == "noon");
  CHECK(result.states()[0].sun->direction == scene.states[0].sun->direction);
  CHECK_FALSE(result.states()[1].sun);
  CHECK(result.states()[1].sky->model == SkyModel::standard_overcast);
  CHECK(result.states()[1].duration_s == 1800);
  REQUIRE(result.facet_count() == facets.size());
  REQUIRE(result.organ_count() == facets.organs.size());

  const std::size_t n = facets.size(), m = facets.organs.size();
  CHECK(result.all<float>("facets/irradiance") == values.irradiance);
  CHECK(result.all<float>("facets/sunlit") == values.sunlit);
  CHECK(result.rows<float>("facets/area", 0, n) == facets.area);
  CHECK(result.facet_organs(0, n) == facets.organ);
  CHECK(result.organs().structure == facets.organs.structure);
  CHECK(result.organs().placements == facets.organs.placements);

  // Absorbed per area by the formula; organs are area-weighted sums. Float storage allows 6e-8 relative to each facet's value.
  const auto absorbed = result.all<float>("facets/absorbed");
  std::vector<double> organ_absorbed(2 * m * 2, 0.0), organ_front(m, 0.0);
  double worst = 0;
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t f = 0; f < n; ++f)
      for (std::size_t b = 0; b < 2; ++b) {
        const auto& o = facets.materials[facets.optics[f]];
        const double front = values.irradiance[((s * n + f) * 2) * 2 + b], back = values.irradiance[((s * n + f) * 2 + 1) * 2 + b];
        const double wanted =
            (1.0 - o.reflectance_front[b] - o.transmittance[b]) * front + (1.0 - o.reflectance_back[b] - o.transmittance[b]) * back;
        worst = std::max(worst, std::abs(absorbed[(s * n + f) * 2 + b] - wanted) / wanted);
        organ_absorbed[(s * m + facets.organ[f]) * 2 + b] += wanted * facets.area[f];
        if (s == 0 && b == 0) organ_front[facets.organ[f]] += front * facets.area[f];
      }
  CHECK(worst < 1e-7);
  const auto stored = result.all<float>("organs/absorbed"), organ_area = result.all<float>("organs/area"),
             organ_irradiance = result.all<float>("organs/irradiance");
  worst = 0;
  for (std::size_t i = 0; i < stored.size(); ++i) worst = std::max(worst, std::abs(stored[i] - organ_absorbed[i]) / organ_absorbed[i]);
  for (std::size_t o = 0; o < m; ++o)
    worst = std::max(worst, std::abs(organ_irradiance[o * 4] - organ_front[o] / organ_area[o]) / organ_irradiance[o * 4]);
  CHECK(worst < 3e-7);

  // The scene can be drawn from the file alone, with the coordinates that the solver had.
  const ResultGeometry geometry = result.geometry();
  REQUIRE(geometry.facet_count() == n);
  CHECK(distance(geometry.corners(0, n), facets.corners) < rounding);
  CHECK(geometry.optics(0, n) == facets.optics);
  for (const std::size_t first : {std::size_t{0}, std::size_t{2}, n / 2, n - 9})
    for (const std::size_t count : {1, 4, 9}) {
      const std::vector<Triangle> part(facets.corners.begin() + static_cast<std::ptrdiff_t>(first),
                                       facets.corners.begin() + static_cast<std::ptrdiff_t>(first + count));
      CHECK(distance(geometry.corners(first, count), part) < rounding);
    }
  CHECK(result.materials()[0].reflectance_back == scene.optics[0].reflectance_back);

  CHECK(result.balance()[0][1].ground == 3);
  CHECK(result.balance()[1][0].scattered_scale == 1.0);
  CHECK(result.balance()[0][1].scattered_scale == 0.998);
  CHECK(result.all<double>("balance/residual")[0] == Approx(0.5));
  CHECK(result.all<double>("balance/albedo")[0] == Approx(0.25));
  CHECK(result.all<double>("balance/absorbed_fraction_leaves")[3] == 0.0);  // no light: no fraction
  const auto profile = result.profile();
  double area = 0, plant_area = 0, power = 0, plant_power = 0;
  for (const double a : profile.area) area += a;
  for (std::size_t l = 0; l < profile.area.size(); ++l) power += profile.absorbed[l * 2];
  for (std::size_t f = 0; f < facets.plant_facets; ++f)
    plant_area += facets.area[f], plant_power += double{absorbed[f * 2]} * facets.area[f];
  CHECK(area == Approx(plant_area));
  CHECK(power == Approx(plant_power));

  CHECK(result.convergence()[1].links == 120);
  CHECK(result.convergence()[1].seconds == 0.5);
  CHECK(result.spectral_radius() == std::vector<double>{0.1, 0.8});
  CHECK(result.timings()[1] == std::pair<std::string, double>("links", 1.5));
  CHECK(result.counts()[1].second == 7);
  CHECK(result.memory()[0].second == 4096);
  const auto certificate = result.certificate();
  REQUIRE(certificate);
  CHECK(certificate->organs == std::vector<std::uint64_t>{1, 3});
  CHECK(certificate->reference[0] == 1.5f);
  CHECK(certificate->bias == std::vector<double>{-0.001, 0.002});
  CHECK(certificate->rays == 12345);
}

TEST_CASE("The same rows give the same bytes", "[result]") {
  const Folder folder;
  const Scene scene = small_scene(2000);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  SolveReport report = small_report();
  for (const char* name : {"a.h5", "b.h5"}) {
    ResultWriter writer(folder / name, scene, placed, OutputChoice{}, "0.1.0", "flat");
    values.send(writer, name[0] == 'a' ? 100 : 1777);
    writer.finish(report);
  }
  const Result a(folder / "a.h5"), b(folder / "b.h5");
  for (const char* name : {"facets/irradiance", "facets/absorbed", "organs/absorbed", "organs/sunlit"})
    CHECK(a.all<float>(name) == b.all<float>(name));
}

TEST_CASE("[output] decides what a result keeps", "[result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  const auto write = [&](const OutputChoice& output) {
    ResultWriter writer(folder / "r.h5", scene, placed, output, "0.1.0", "reference");
    values.send(writer, 1000, true);
    auto report = small_report();
    writer.finish(report);
    return Result(folder / "r.h5");
  };
  SECTION("everything") {
    const auto r = write({});
    CHECK(r.all<float>("variance/facets") == values.variance);
    // Facets are independent: sums of area^2 x variance.
    std::vector<double> sums(2 * facets.organs.size() * 2, 0.0);
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t f = 0; f < facets.size(); ++f)
        for (std::size_t b = 0; b < 2; ++b)
          sums[(s * facets.organs.size() + facets.organ[f]) * 2 + b] +=
              double{facets.area[f]} * facets.area[f] * values.variance[(s * facets.size() + f) * 2 + b];
    CHECK(r.all<float>("variance/organs") == std::vector<float>(sums.begin(), sums.end()));
    CHECK_FALSE(r.has("certificate"));
  }
  SECTION("organs only") {
    const auto r = write({false, {}});
    CHECK_FALSE(r.has("facets"));
    CHECK(r.facet_count() == 0);
    CHECK(r.has("organs/absorbed"));
    CHECK(distance(r.geometry().corners(0, facets.size()), facets.corners) < rounding);
  }
  SECTION("two datasets") {
    const auto r = write({true, {"facets/absorbed", "organs/absorbed"}});
    CHECK(r.has("facets/absorbed"));
    CHECK(r.has("facets/area"));
    CHECK_FALSE(r.has("facets/irradiance"));
    CHECK_FALSE(r.has("organs/irradiance"));
    CHECK_FALSE(r.has("geometry"));
    CHECK_FALSE(r.has("variance"));
  }
  SECTION("a misspelt name") {
    CHECK_THROWS_WITH(
        write({true, {"facets/absorbd"}}),
        "scene in memory: output.fields: found \"facets/absorbd\"; expected a dataset of the result, such as \"facets/absorbed\"");
    CHECK(folder.files() == 0);
  }
}

TEST_CASE("A scene without sun stores no sunlit fractions, and they read as zero", "[result]") {
  const Folder folder;
  Scene scene = small_scene(3000);
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
  writer.rows({0, facets.size(), values.irradiance.data(), nullptr, nullptr});
  writer.finish(small_report());
  const Result result(folder / "r.h5");
  const auto sunlit = result.all<float>("facets/sunlit");
  CHECK(sunlit == std::vector<float>(2 * facets.size() * 2, 0.0f));
}
