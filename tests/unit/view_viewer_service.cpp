// What the viewer answers, without a network.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "result_scene.hpp"
#include "view/viewer_service.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

using nlohmann::json;
using Query = std::map<std::string, std::string>;

std::string stored(const std::string& file, const Scene& scene, const FacetScene& facets, float factor = 1) {
  Values values(facets);
  for (auto& e : values.irradiance) e *= factor;
  const PlacedScene placed = place(scene);
  ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
  values.send(writer, 1000);
  writer.finish(small_report());
  return file;
}

struct Fixture {
  Folder folder;
  Scene scene = small_scene();
  FacetScene facets = expand(scene);
  std::string file = stored(folder / "r.h5", scene, facets);
};

Answer answer(ViewerService& service, const std::string& path, const Query& query = {}, bool post = false) {
  return service.answer(post, path, [&](const std::string& name) {
    const auto at = query.find(name);
    return at == query.end() ? std::nullopt : std::optional(at->second);
  });
}

json parsed(ViewerService& service, const std::string& path, const Query& query = {}) {
  const Answer a = answer(service, path, query);
  INFO(a.body);
  REQUIRE(a.status == 200);
  return json::parse(a.body);
}

std::string text(const Vec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

}  // namespace

TEST_CASE("the viewer refuses results that do not fit into memory", "[view][viewer]") {
  CHECK_NOTHROW(check_viewer_memory("r.h5", 1000000, 1000000, 570000000));
  CHECK_NOTHROW(check_viewer_memory("r.h5", 1000000, 1000000, 0));
  CHECK_THROWS_WITH(
      check_viewer_memory("r.h5", 100032000, 100000, std::size_t{16} << 30),
      "r.h5: found 100032000 facets, which take about 20.5 GiB to view; expected at most 16.0 GiB, three quarters of what is free on "
      "this machine; 'sunfleck render' draws results of any size");
}

TEST_CASE_METHOD(Fixture, "the viewer serves its page at once and the result when it is read", "[view][viewer]") {
  ViewerService service({file});
  CHECK(answer(service, "/").status == 200);
  CHECK(answer(service, "/").type == "text/html; charset=utf-8");
  CHECK(answer(service, "/main.js").type == "text/javascript; charset=utf-8");
  CHECK(answer(service, "/api/describe").status == 503);
  CHECK(parsed(service, "/api/status").at("ready") == false);
  service.load();
  CHECK(parsed(service, "/api/status").at("ready") == true);
  const json about = parsed(service, "/api/describe");
  const json& result = about.at("results").at(0);
  CHECK(result.at("facets") == facets.size());
  CHECK(result.at("organs") == facets.organs.size());
  CHECK(result.at("bands") == json({"PAR", "NIR"}));
  CHECK(result.at("states") == json({"noon", "evening"}));
  CHECK(result.at("units").at(0) == "W m⁻²");
  CHECK(about.at("difference") == false);
  CHECK(answer(service, "/api/nothing").status == 404);
  CHECK(answer(service, "/../CMakeLists.txt").status == 404);
  CHECK(answer(service, "/main.js", {}, true).status == 405);
  CHECK(answer(service, "/api/reload").status == 405);
}

TEST_CASE_METHOD(Fixture, "what a request gets wrong is named, and nothing else happens", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  const std::string n = std::to_string(facets.organs.size());
  const std::vector<std::tuple<std::string, Query, std::string>> cases{
      {"/api/frame", {{"width", "abc"}}, "width: found 'abc'; expected a whole number from 16 to 8192"},
      {"/api/frame", {{"width", "15"}}, "width: found '15'; expected a whole number from 16 to 8192"},
      {"/api/frame", {{"width", "8192"}, {"height", "8192"}}, "width: found '8192'; expected at most 8000000 pixels in all"},
      {"/api/frame", {{"distance", "nan"}}, "distance: found 'nan'; expected a number from 1e-09 to 1e+12"},
      {"/api/frame", {{"distance", "-1"}}, "distance: found '-1'; expected a number from 1e-09 to 1e+12"},
      {"/api/frame", {{"elevation", "90"}}, "elevation: found '90'; expected a number from -89.9 to 89.9"},
      {"/api/frame", {{"target", "1,2"}}, "target: found '1,2'; expected 3 finite numbers with commas between"},
      {"/api/frame", {{"target", "1,2,3,"}}, "target: found '1,2,3,'; expected 3 finite numbers with commas between"},
      {"/api/frame", {{"target", "1,2,inf"}}, "target: found '1,2,inf'; expected 3 finite numbers with commas between"},
      {"/api/frame", {{"cut", "0,0,0,1"}}, "cut: found '0,0,0,1'; expected a normal that is not zero, and an offset"},
      {"/api/frame", {{"range", "2,1"}}, "range: found '2,1'; expected the lower number first"},
      {"/api/frame", {{"range", "0,1"}, {"log", "1"}}, "range: found '0,1'; expected numbers above zero on a logarithmic scale"},
      {"/api/frame", {{"log", "yes"}}, "log: found 'yes'; expected 0 or 1"},
      {"/api/frame",
       {{"map", "virids"}},
       "--colormap: found 'virids'; expected one of viridis, magma, inferno, cividis, grey, difference (did you mean 'viridis'?)"},
      {"/api/frame", {{"band", "2"}}, "band: found '2'; expected a whole number from 0 to 1"},
      {"/api/frame", {{"band", "99999999999999999999"}}, "band: found '99999999999999999999'; expected a whole number from 0 to 1"},
      {"/api/frame", {{"result", "1"}}, "result: found '1'; expected a whole number from 0 to 0"},
      {"/api/frame", {{"select", "leaf"}}, "select: found 'leaf'; expected placement:, plant:, type: or organ: and rows"},
      {"/api/frame", {{"select", "size:1"}}, "select: found 'size:1'; expected placement:, plant:, type: or organ: and rows"},
      {"/api/frame", {{"select", "organ:0-" + n}}, "select: found '" + n + "'; expected a row below " + n},
      {"/api/frame", {{"select", "organ:-"}}, "select: found ''; expected a row below " + n},
      {"/api/frame", {{"highlight", n}}, "highlight: found '" + n + "'; expected a row below " + n},
      {"/api/frame", {{"time", "100000"}}, "time: found '100000'; expected a whole number from 0 to 2000"},
      {"/api/frame", {{"difference", "1"}, {"quantity", "absorbed"}}, "difference: found '1'; expected 0; only one result is open"},
      {"/api/pick", {{"x", "1.5"}}, "x: found '1.5'; expected a number from 0 to 1"},
      {"/api/organ", {{"organ", n}}, fmt::format("organ: found '{}'; expected a whole number from 0 to {}", n, facets.organs.size() - 1)},
      {"/api/statistics", {{"bins", "0"}}, "bins: found '0'; expected a whole number from 1 to 1000"}};
  for (const auto& [path, query, expected] : cases) {
    const Answer a = answer(service, path, query);
    CHECK(a.status == 400);
    CHECK(json::parse(a.body).at("error") == expected);
  }
  const Answer unknown = answer(service, "/api/statistics", {{"quantity", std::string(5000, 'x')}});
  CHECK(unknown.status == 400);
  CHECK(unknown.body.size() < 1000);  // what was found is cut short
}

TEST_CASE_METHOD(Fixture, "a pick returns the numbers of the file", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  const Result result(file);
  const std::size_t bands = 2;
  std::size_t picked = 0;
  for (std::uint32_t f = 0; f < facets.plant_facets; ++f) {
    // A parallel camera that looks at the facet's front, at a picture a hundredth of its size.
    const Vec3 area = area_vector(facets.corners[f]);
    if (!(glm::length(area) > 0)) continue;
    const Vec3 n = glm::normalize(area), middle = (facets.corners[f][0] + facets.corners[f][1] + facets.corners[f][2]) / 3.0;
    const double elevation = std::clamp(std::asin(n.z) * 57.29577951308232, -89.0, 89.0),
                 azimuth = std::atan2(n.x, n.y) * 57.29577951308232;
    const Query query{{"state", "1"},
                      {"azimuth", fmt::format("{}", azimuth)},
                      {"elevation", fmt::format("{}", elevation)},
                      {"target", text(middle)},
                      {"distance", "0.001"},
                      {"orthographic", "1"},
                      {"quantity", "absorbed"},
                      {"band", "1"},
                      {"cut", text(n) + fmt::format(",{}", glm::dot(n, middle) + 1e-4)},  // nothing stands before it
                      {"x", "0.5"},
                      {"y", "0.5"}};
    const json found = parsed(service, "/api/pick", query);
    if (found.at("facet").at("row") != f) continue;  // two leaves that touch
    ++picked;
    const std::size_t o = facets.organ[f];
    CHECK(found.at("side") == "front");
    CHECK(found.at("organ") == o);
    CHECK(found.at("name") == facets.organs.names[facets.organs.name[o]]);
    CHECK(found.at("placement") == facets.organs.placements[facets.organs.placement[o]]);
    CHECK(found.at("area") == result.rows<float>("organs/area", o, 1)[0]);
    CHECK(found.at("absorbed") == json(result.state_rows<float>("organs/absorbed", 1, o, 1)));
    const auto e = result.state_rows<float>("organs/irradiance", 1, o, 1), fe = result.state_rows<float>("facets/irradiance", 1, f, 1);
    const auto taken = result.state_rows<float>("facets/absorbed", 1, f, 1);
    for (std::size_t b = 0; b < bands; ++b) {
      CHECK(found.at("irradiance").at("front").at(b) == e[b]);
      CHECK(found.at("irradiance").at("back").at(b) == e[bands + b]);
      CHECK(found.at("facet").at("irradiance").at("front").at(b) == fe[b]);
      CHECK(found.at("facet").at("irradiance").at("back").at(b) == fe[bands + b]);
      CHECK(found.at("facet").at("absorbed").at(b) == taken[b]);
    }
    CHECK(found.at("value") == taken[1]);
    CHECK(found.at("facet").at("sunlit").at("front") == result.state_rows<float>("facets/sunlit", 1, f, 1)[0]);
  }
  CHECK(picked >= facets.plant_facets / 2);
  CHECK(parsed(service, "/api/pick", {{"target", "0,0,100"}, {"distance", "1"}, {"elevation", "-80"}}).at("organ").is_null());
}

TEST_CASE_METHOD(Fixture, "statistics of a selection add up to the file's organs", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  const Result result(file);
  const auto area = result.all<float>("organs/area");
  const auto absorbed = result.state_rows<float>("organs/absorbed", 0, 0, result.organ_count());
  const auto& organs = facets.organs;
  const auto leaf = static_cast<std::size_t>(std::find(organs.types.begin(), organs.types.end(), "Leaf") - organs.types.begin());
  double all_area = 0, all_power = 0;
  std::size_t count = 0;
  for (std::size_t o = 0; o < organs.size(); ++o)
    if (organs.type[o] == leaf && organs.placement[o] < 2) ++count, all_area += area[o], all_power += absorbed[2 * o + 1];
  const json s =
      parsed(service, "/api/statistics", {{"quantity", "absorbed"}, {"band", "1"}, {"select", fmt::format("placement:0-1;type:{}", leaf)}});
  CHECK(s.at("organs") == count);
  CHECK(s.at("area").get<double>() == Approx(all_area).epsilon(1e-6));  // sums of floats
  CHECK(s.at("absorbed").at(1).get<double>() == Approx(all_power).epsilon(1e-6));
  CHECK(s.at("mean").get<double>() == Approx(all_power / all_area).epsilon(1e-6));
  double histogram = 0, profile = 0;
  for (const auto& a : s.at("histogram").at("area")) histogram += a.get<double>();
  for (const auto& a : s.at("profile").at("area")) profile += a.get<double>();
  CHECK(histogram == Approx(all_area).epsilon(1e-6));
  CHECK(profile == Approx(all_area).epsilon(1e-6));

  const Answer csv = answer(service, "/api/profile.csv", {{"quantity", "absorbed"}, {"layers", "3"}});
  CHECK(csv.type == "text/csv; charset=utf-8");
  CHECK(csv.body.starts_with("height_from_m,height_to_m,area_m2,mean absorbed PAR [W m⁻²],absorbed_W_PAR,absorbed_W_NIR\r\n"));
  CHECK(std::count(csv.body.begin(), csv.body.end(), '\n') == 4);
  // Without a selection, plants only; the ground where it is named.
  CHECK(parsed(service, "/api/statistics").at("facets") == facets.plant_facets);
  const auto ground = static_cast<std::size_t>(std::find(organs.types.begin(), organs.types.end(), "ground") - organs.types.begin());
  CHECK(parsed(service, "/api/statistics", {{"select", fmt::format("type:{}", ground)}}).at("facets") ==
        facets.size() - facets.plant_facets);
  // Names that are not there are not listed.
  CHECK(parsed(service, "/api/statistics", {{"quantity", "type"}}).at("categories").size() == 2);
  CHECK(parsed(service, "/api/statistics", {{"quantity", "type"}, {"select", fmt::format("type:{}", leaf)}}).at("categories") ==
        json({"Leaf"}));
  CHECK(parsed(service, "/api/legend", {{"quantity", "type"}}).at("names").size() == 2);
  CHECK(parsed(service, "/api/legend", {{"quantity", "type"}, {"map_ground", "1"}}).at("names").size() == 3);
}

TEST_CASE_METHOD(Fixture, "organs and plants are found by name", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  const json found = parsed(service, "/api/search", {{"text", "FLAG"}});
  CHECK(found.at("total") == 4);  // one on each of four plants
  CHECK(found.at("organs").at(0).at("name") == "flag");
  CHECK(parsed(service, "/api/search", {{"text", "shrub[0]/flag"}}).at("total") == 2);  // also row[0]/shrub[0]
  CHECK(parsed(service, "/api/search", {{"text", "row[0]/shrub[0]/flag"}}).at("total") == 1);
  CHECK(parsed(service, "/api/search", {{"text", "nobody"}}).at("total") == 0);
  CHECK(parsed(service, "/api/search").at("total") == 0);
  CHECK(parsed(service, "/api/placements", {{"text", "row"}}).at("total") == 2);
}

TEST_CASE_METHOD(Fixture, "a picture does not depend on threads or on how its time was cut", "[view][viewer]") {
  const Query query{{"target", "0,1,0.3"}, {"distance", "8"}, {"width", "120"},
                    {"height", "80"},      {"format", "png"}, {"quantity", "absorbed"}};
  const auto finished = [&](const char* time, std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    ViewerService service({file});
    service.load();
    auto with_time = query;
    with_time["time"] = time;
    for (int k = 0; k < 2000; ++k) {
      const Answer a = answer(service, "/api/frame", with_time);
      REQUIRE(a.status == 200);
      if (std::find(a.headers.begin(), a.headers.end(), std::pair<std::string, std::string>("X-Done", "1")) != a.headers.end())
        return a.body;
    }
    FAIL("the picture is never finished");
    return std::string();
  };
  const std::string picture = finished("2000", 1);
  CHECK(picture.starts_with("\x89PNG"));
  CHECK(finished("0", 2) == picture);
}

TEST_CASE_METHOD(Fixture, "the difference of two results", "[view][viewer]") {
  const std::string other = stored(folder / "twice.h5", scene, facets, 2);
  ViewerService service({file, other});
  service.load();
  CHECK(parsed(service, "/api/describe").at("difference") == true);
  const Query query{{"quantity", "irradiance_front"}, {"difference", "1"}};
  const json s = parsed(service, "/api/statistics", query), first = parsed(service, "/api/statistics", {{"quantity", "irradiance_front"}});
  CHECK(s.at("mean").get<double>() == Approx(first.at("mean").get<double>()).epsilon(1e-6));
  CHECK(s.at("title").at(0) == "difference of irradiance PAR, front");
  const json legend = parsed(service, "/api/legend", query);
  CHECK(legend.at("low").get<double>() == -legend.at("high").get<double>());
  CHECK(answer(service, "/api/frame", query).status == 200);
  CHECK(answer(service, "/api/frame", {{"quantity", "colour"}, {"difference", "1"}}).status == 400);
  CHECK(answer(service, "/api/legend", {{"quantity", "type"}, {"difference", "1"}}).status == 400);

  CHECK(parsed(service, "/api/describe").at("notes").empty());
  Scene brighter = scene;
  brighter.states[0].sun->irradiance[0] *= 2;
  ViewerService light({file, stored(folder / "brighter.h5", brighter, facets)});
  light.load();
  CHECK(parsed(light, "/api/describe").at("difference") == true);
  CHECK(parsed(light, "/api/describe").at("notes").at(0) == "their light differs: sun of state noon");

  Scene elsewhere = scene;  // as many facets and organs, of the same areas
  elsewhere.plants[0].placements[1].map.translation.x += 0.3;
  ViewerService moved({file, stored(folder / "moved.h5", elsewhere, expand(elsewhere))});
  moved.load();
  CHECK(parsed(moved, "/api/describe").at("difference") == false);
  CHECK(parsed(moved, "/api/describe").at("notes").at(0).get<std::string>().starts_with("they are not of the same scene: facet "));
  CHECK(answer(moved, "/api/frame", query).status == 400);

  const Scene small = small_scene(2);
  const FacetScene few = expand(small);
  ViewerService unlike({file, stored(folder / "few.h5", small, few)});
  unlike.load();
  CHECK(parsed(unlike, "/api/describe").at("difference") == false);
  const Answer a = answer(unlike, "/api/frame", query);
  CHECK(a.status == 400);
  CHECK(json::parse(a.body).at("error") == "difference: found '1'; expected 0; the results are not of the same scene");
}

TEST_CASE_METHOD(Fixture, "a file that is replaced is noticed, and read again on request", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  const double before = parsed(service, "/api/statistics", {{"quantity", "irradiance_front"}}).at("mean");
  CHECK(parsed(service, "/api/status").at("changed").empty());
  std::filesystem::rename(stored(folder / "new.h5", scene, facets, 3), file);
  CHECK(parsed(service, "/api/status").at("changed").at(0).at("file") == file);
  // What is on the screen stays what it was, also what is read only now.
  CHECK(parsed(service, "/api/statistics", {{"quantity", "irradiance_front"}}).at("mean") == before);
  CHECK(parsed(service, "/api/statistics", {{"quantity", "irradiance_back"}}).at("mean").get<double>() < 2 * before);
  CHECK(answer(service, "/api/reload", {}, true).status == 200);
  CHECK(parsed(service, "/api/status").at("changed").empty());
  CHECK(parsed(service, "/api/statistics", {{"quantity", "irradiance_front"}}).at("mean").get<double>() == Approx(3 * before));

  std::filesystem::remove(file);
  std::ofstream(file) << "no result";
  const Answer bad = answer(service, "/api/reload", {}, true);
  CHECK(bad.status == 409);
  CHECK(json::parse(bad.body).at("error") == file + ": found something else than HDF5; expected a result file");
  CHECK(answer(service, "/api/frame").status == 200);
  std::filesystem::remove(file);
  CHECK(parsed(service, "/api/status").at("changed").at(0).at("missing") == true);
}

TEST_CASE_METHOD(Fixture, "a file that is damaged in place gives an error, not the end", "[view][viewer]") {
  ViewerService service({file});
  service.load();
  std::filesystem::resize_file(file, 4096);
  const Answer a = answer(service, "/api/statistics", {{"quantity", "sunlit_back"}});
  CHECK((a.status == 200 || a.status == 409));  // 200 where the pieces were read before
  CHECK(parsed(service, "/api/status").at("changed").size() == 1);
}
