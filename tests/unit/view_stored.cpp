#include <catch2/catch.hpp>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/stored.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// A result of small_scene() as a solver would leave it.
std::string stored(const Folder& folder, const Scene& scene, const FacetScene& facets, const char* name = "r.h5",
                   const OutputChoice& output = {}) {
  const Values values(facets);
  const PlacedScene placed = place(scene);
  ResultWriter writer(folder / name, scene, placed, output, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
  return folder / name;
}

}  // namespace

TEST_CASE("a stored scene is the scene that was solved", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene solved = expand(scene);
  const Result result(stored(folder, scene, solved));
  const FacetScene read = stored_scene(result);
  REQUIRE(read.size() == solved.size());
  REQUIRE(read.plant_facets == solved.plant_facets);
  for (std::size_t f = 0; f < solved.size(); ++f) {
    REQUIRE(read.corners[f] == solved.corners[f]);
    REQUIRE(read.area[f] == solved.area[f]);
    REQUIRE(read.organ[f] == solved.organ[f]);
    REQUIRE(read.materials[read.optics[f]].name == solved.materials[solved.optics[f]].name);
  }
  REQUIRE(stored_scene(result, false).size() == solved.plant_facets);
}

TEST_CASE("a file that keeps organs only still tells which facet belongs to which organ", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene solved = expand(scene);
  const Result result(stored(folder, scene, solved, "r.h5", {false, {}}));
  const FacetScene read = stored_scene(result);
  REQUIRE(read.organ == solved.organ);
  const FacetMap map = stored_map(result, read, {});
  const auto power = result.state_rows<float>("organs/absorbed", 0, 0, result.organ_count());
  const auto area = result.all<float>("organs/area");
  const std::size_t b = result.bands().size(), organ = read.organ[2];
  REQUIRE(map.title.at(1) == "organ means");
  REQUIRE(map.values[2] == Approx(power[organ * b] / area[organ]).epsilon(1e-6));  // one division in float
  const StateLight light = stored_light(result, read, 0);
  REQUIRE(light.irradiance.size() == 2 * b * read.size());
  const DrawnScene drawn(result);
  const LightSource source = stored_light(result, drawn, 0);
  REQUIRE(source.irradiance(0, read.size()) == light.irradiance);
  REQUIRE(source.irradiance(3, 4) == std::vector<float>(light.irradiance.begin() + static_cast<std::ptrdiff_t>(6 * b),
                                                        light.irradiance.begin() + static_cast<std::ptrdiff_t>(14 * b)));
  REQUIRE_FALSE(source.sunlit);
  REQUIRE(light.sunlit.empty());
}

TEST_CASE("maps hold the values of the file, with title, unit and scale", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene solved = expand(scene);
  const Result result(stored(folder, scene, solved));
  const FacetScene read = stored_scene(result);
  const std::size_t n = read.size(), b = result.bands().size(), state = result.states().size() - 1, band = b - 1;
  const auto irradiance = result.state_rows<float>("facets/irradiance", state, 0, n);
  const auto absorbed = result.state_rows<float>("facets/absorbed", state, 0, n);
  const auto map = [&](const char* quantity) {
    MapChoice choice;
    choice.quantity = quantity, choice.band = band, choice.state = state, choice.reference = &result;
    return stored_map(result, read, choice);
  };
  const FacetMap seen = map("irradiance"), front = map("irradiance_front"), back = map("irradiance_back"), taken = map("absorbed");
  REQUIRE(seen.sides);
  REQUIRE_FALSE(front.sides);
  REQUIRE(taken.title.at(0) == "absorbed " + result.bands()[band]);
  for (std::size_t f = 0; f < n; ++f) {
    REQUIRE(front.values[f] == irradiance[2 * b * f + band]);
    REQUIRE(back.values[f] == irradiance[2 * b * f + b + band]);
    REQUIRE(seen.values[2 * f] == front.values[f]);
    REQUIRE(seen.values[2 * f + 1] == back.values[f]);
    REQUIRE(taken.values[f] == absorbed[b * f + band]);
  }
  const FacetMap types = map("type");
  for (std::size_t f = 0; f < n; ++f)
    REQUIRE(types.names.at(static_cast<std::size_t>(types.values[f])) == solved.organs.types[solved.organs.type[solved.organ[f]]]);
  for (const auto& quantity : quantity_names()) {
    if (quantity == "colour") continue;
    INFO(quantity);
    const FacetMap any = map(quantity.c_str());
    REQUIRE(any.values.size() == (any.sides ? 2 * n : n));
    REQUIRE_FALSE(any.title.empty());
    REQUIRE((!any.names.empty() || any.scale.high > any.scale.low));
  }
}

TEST_CASE("a map read in pieces from a scene that is not written out is the map of the scene in memory", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const Result result(stored(folder, scene, expand(scene)));
  const FacetScene read = stored_scene(result);
  const DrawnScene drawn(result);
  REQUIRE(drawn.size() == read.size());
  for (std::size_t f = 0; f < read.size(); ++f) {
    const auto place = drawn.place(f);
    REQUIRE(drawn.corners(place) == read.corners[f]);
    REQUIRE(drawn.organ(place) == read.organ[f]);
    REQUIRE(drawn.optics(place) == read.optics[f]);
    REQUIRE(drawn.organ_type(place) == read.organs.types[read.organs.type[read.organ[f]]]);
    REQUIRE(drawn.run_begin(place) + place.triangle == f);
  }
  for (const auto& quantity : quantity_names()) {
    if (quantity == "colour") continue;
    INFO(quantity);
    MapChoice choice;
    choice.quantity = quantity, choice.reference = &result;
    const FacetMap whole = stored_map(result, read, choice);
    const MapSource source = stored_map(result, drawn, choice, silent());
    REQUIRE(source.title == whole.title);
    REQUIRE(source.names == whole.names);
    REQUIRE(source.scale.low == whole.scale.low);
    REQUIRE(source.scale.high == whole.scale.high);
    std::vector<float> pieces;
    for (std::size_t first = 0; first < read.size(); first += 7) {
      const auto part = source.values(first, std::min<std::size_t>(7, read.size() - first));
      pieces.insert(pieces.end(), part.begin(), part.end());
    }
    REQUIRE(pieces == whole.values);
  }
}

TEST_CASE("the error of a map is in percent of the reference's mean, and needs a reference of the same scene", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const Result reference(stored(folder, scene, facets, "reference.h5"));
  Values brighter(facets);
  for (auto& e : brighter.irradiance) e *= 1.1f;
  {
    const PlacedScene placed = place(scene);
    ResultWriter writer(folder / "brighter.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
    brighter.send(writer, 1000);
    writer.finish(small_report());
  }
  const Result result(folder / "brighter.h5");
  const DrawnScene drawn(result);
  MapChoice choice;
  choice.quantity = "organ_error";
  REQUIRE_THROWS_WITH(stored_map(result, drawn, choice, silent()),
                      "--quantity organ_error: found no reference; expected --reference RESULT.h5");
  choice.reference = &reference;
  const auto organs = stored_map(result, drawn, choice, silent()).values(0, drawn.plant_facets());
  const auto area = result.rows<float>("facets/area", 0, drawn.plant_facets());
  double sum = 0, all = 0;
  for (std::size_t f = 0; f < organs.size(); ++f) sum += organs[f] * area[f], all += area[f];
  REQUIRE(sum / all == Approx(10).epsilon(1e-4));  // every value is a tenth higher: so is the mean; kept as float
  const MapSource map = stored_map(result, drawn, choice, silent());
  REQUIRE(map.scale.low == -map.scale.high);
  REQUIRE(map.title.back() == "% of mean absorbed");

  Scene other = small_scene(5);
  const Result stranger(stored(folder, other, expand(other), "other.h5"));
  choice.reference = &stranger;
  REQUIRE_THROWS_AS(stored_map(result, drawn, choice, silent()), InputError);
  Scene moved = scene;
  moved.plants[0].placements[0].map.translation.y += 0.1;
  const Result elsewhere(stored(folder, moved, expand(moved), "moved.h5"));
  choice.reference = &elsewhere;
  REQUIRE_THROWS_WITH(stored_map(result, drawn, choice, silent()), Catch::Contains("only results of the same scene can be compared"));
}

TEST_CASE("the scale of a map comes from plants, with the ground where that is mapped", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const Result result(stored(folder, scene, expand(scene)));
  const FacetScene read = stored_scene(result);
  MapChoice choice;
  choice.quantity = "area";  // ground facets, 4 m x 3 m in 12 pieces, are larger than any leaf
  const FacetMap plants = stored_map(result, read, choice);
  choice.ground = true;
  const FacetMap all = stored_map(result, read, choice);
  REQUIRE(plants.scale.high < 1.0);
  REQUIRE(all.scale.high == Approx(1.0).epsilon(1e-6));  // areas are kept as float
}

TEST_CASE("names that the file does not hold are refused with the nearest one", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const std::string file = stored(folder, scene, expand(scene));
  const Result result(file);
  const FacetScene read = stored_scene(result);
  REQUIRE(band_row(result, result.bands().back()) == result.bands().size() - 1);
  REQUIRE(state_row(result, "1") == 0);
  REQUIRE(state_row(result, result.states().back().name) == result.states().size() - 1);
  REQUIRE_THROWS_WITH(band_row(result, "PAT"),
                      Catch::Matchers::StartsWith("--band: found 'PAT'; expected one of those in " + file + ": ") &&
                          Catch::Matchers::EndsWith("(did you mean 'PAR'?)"));
  REQUIRE_THROWS_WITH(state_row(result, "99"), Catch::Matchers::StartsWith("--state: found '99'; expected one of those in " + file + ": "));
  MapChoice choice;
  choice.quantity = "absorbd";
  REQUIRE_THROWS_WITH(stored_map(result, read, choice), Catch::Matchers::EndsWith("(did you mean 'absorbed'?)"));
  choice.quantity = "absorbed", choice.range = {5, 5};
  REQUIRE_THROWS_WITH(stored_map(result, read, choice), "--range: found 5 5; expected two finite numbers, the lower first");
  choice.range = {0, 5}, choice.logarithmic = true;
  REQUIRE_THROWS_WITH(stored_map(result, read, choice), "--range: found 0 with --log; expected numbers above zero");
}

TEST_CASE("a file without the quantity asked for says so", "[view][result]") {
  const Folder folder;
  const Scene scene = small_scene();
  const Result result(stored(folder, scene, expand(scene), "r.h5", {true, {"organs/absorbed", "geometry"}}));
  const FacetScene read = stored_scene(result);
  REQUIRE_THROWS_WITH(stored_light(result, read, 0),
                      Catch::Matchers::EndsWith("expected irradiance of facets or organs; [output] of the scene left both out"));
  MapChoice choice;
  choice.quantity = "sunlit";
  REQUIRE_THROWS_AS(stored_map(result, read, choice), InputError);
  REQUIRE_THROWS_WITH(stored_scene(Result(stored(folder, scene, expand(scene), "bare.h5", {true, {"organs/absorbed"}}))),
                      Catch::Matchers::Contains("left them out"));
}
