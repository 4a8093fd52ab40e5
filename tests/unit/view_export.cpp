#include <catch2/catch.hpp>

#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/view/export.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// An own small reader of the PLY that export_ply promises.
struct Ply {
  explicit Ply(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string line, element;
    std::getline(in, line);
    REQUIRE(line == "ply");
    while (std::getline(in, line) && line != "end_header") {
      std::istringstream words(line);
      std::string key, type, name;
      words >> key;
      if (key == "element") words >> element >> (element == "vertex" ? vertex_count : face_count);
      if (key != "property") continue;
      words >> type >> name;
      if (type == "list") continue;
      if (element == "face") properties.emplace_back(name, type);
    }
    vertices.resize(vertex_count);
    in.read(reinterpret_cast<char*>(vertices.data()), static_cast<std::streamsize>(vertex_count * sizeof(Vec3)));
    for (std::size_t f = 0; f < face_count; ++f) {
      char three = 0;
      std::array<std::int32_t, 3> corners{};
      in.read(&three, 1);
      REQUIRE(three == 3);
      in.read(reinterpret_cast<char*>(corners.data()), sizeof corners);
      triangles.push_back({vertices.at(static_cast<std::size_t>(corners[0])), vertices.at(static_cast<std::size_t>(corners[1])),
                           vertices.at(static_cast<std::size_t>(corners[2]))});
      for (const auto& [name, type] : properties) {
        if (type == "uchar") {
          unsigned char value = 0;
          in.read(reinterpret_cast<char*>(&value), 1);
          values[name].push_back(value);
        } else if (type == "int") {
          std::int32_t value = 0;
          in.read(reinterpret_cast<char*>(&value), 4);
          values[name].push_back(value);
        } else {
          float value = 0;
          in.read(reinterpret_cast<char*>(&value), 4);
          values[name].push_back(double{value});
        }
      }
    }
    REQUIRE(in.good());
    in.get();
    CHECK(in.eof());
  }

  std::size_t vertex_count = 0, face_count = 0;
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::map<std::string, std::vector<double>> values;
};

struct Stored {
  Stored() {
    scene.plants[0].name = "shrub, \"big\"";
    facets = expand(scene);
    const PlacedScene placed = place(scene);
    ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "flat");
    Values(facets).send(writer, 1000);
    writer.finish(small_report());
  }
  Folder folder;
  Scene scene = small_scene();
  FacetScene facets;
};

std::vector<std::string> split(const std::string& line) {  // RFC 4180
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        fields.back() += line[++i];
      else
        quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

}  // namespace

TEST_CASE("A lit PLY holds every facet, in order, with every stored quantity", "[view][export]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  const Values values(stored.facets);
  const std::size_t n = stored.facets.size();
  SECTION("all states") {
    export_ply(result, stored.folder / "m.ply", {}, silent());
    const Ply ply(stored.folder / "m.ply");
    REQUIRE(ply.face_count == n);
    double worst = 0;
    for (std::size_t f = 0; f < n; ++f)
      for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, glm::length(ply.triangles[f][c] - stored.facets.corners[f][c]));
    CHECK(worst < 1e-12);  // doubles; roundings of one affine map
    CHECK(ply.vertex_count < 3 * n);
    for (std::size_t f = 0; f < n; ++f) {
      CHECK(ply.values.at("irradiance_back_NIR_noon")[f] == double{values.irradiance[(f * 2 + 1) * 2 + 1]});
      CHECK(ply.values.at("irradiance_front_PAR_evening")[f] == double{values.irradiance[((n + f) * 2) * 2]});
      CHECK(ply.values.at("sunlit_back_noon")[f] == double{values.sunlit[f * 2 + 1]});
      CHECK(ply.values.at("organ")[f] == stored.facets.organ[f]);
      CHECK(ply.values.at("quality")[f] == ply.values.at("absorbed_PAR_noon")[f]);
    }
    CHECK(ply.properties[0].first == "red");
    CHECK(ply.properties.size() == 3 + 3 + 2 * (2 * 3 + 2));
  }
  SECTION("one state as a map") {
    export_ply(result, stored.folder / "m.ply", {"irradiance_front", 1, 1, ColorMap::viridis}, silent());
    const Ply ply(stored.folder / "m.ply");
    CHECK(ply.properties.size() == 3 + 3 + 2 * 3 + 2);
    CHECK(ply.values.at("quality") == ply.values.at("irradiance_front_NIR"));
    // viridis runs from dark violet to yellow: the largest value has more green than the smallest
    const auto& q = ply.values.at("quality");
    const auto low = std::min_element(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(stored.facets.plant_facets)) - q.begin();
    const auto high = std::max_element(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(stored.facets.plant_facets)) - q.begin();
    CHECK(ply.values.at("green")[static_cast<std::size_t>(high)] > 200);
    CHECK(ply.values.at("green")[static_cast<std::size_t>(low)] < 30);
  }
  SECTION("an unknown quantity") {
    CHECK_THROWS_WITH(export_ply(result, stored.folder / "m.ply", {"absorbd", 0, {}, ColorMap::viridis}, silent()),
                      "--quantity: found 'absorbd'; expected colour, absorbed, irradiance_front, irradiance_back, sunlit_front, "
                      "sunlit_back, type, optics (did you mean 'absorbed'?)");
    CHECK(stored.folder.files() == 1);
  }
}

TEST_CASE("A table per organ has sums over the day", "[view][export]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  export_csv(result, stored.folder / "o.csv", silent());
  std::ifstream in(stored.folder / "o.csv");
  std::string line;
  std::getline(in, line);
  const auto names = split(line);
  CHECK(line.rfind("organ,plant,placement,name,type,area_m2,absorbed_W_PAR_noon,irradiance_front_PAR_noon,irradiance_back_PAR_noon,"
                   "absorbed_W_NIR_noon,",
                   0) == 0);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const auto absorbed = result.all<float>("organs/absorbed");
  const std::size_t m = result.organ_count();
  for (std::size_t o = 0; o < m; ++o) {
    REQUIRE(std::getline(in, line));
    const auto row = split(line);
    REQUIRE(row.size() == names.size());
    CHECK(row[0] == std::to_string(o));
    CHECK(std::stof(row[column("absorbed_W_NIR_evening")]) == absorbed[(m + o) * 2 + 1]);
    CHECK(std::stod(row[column("absorbed_J_PAR")]) == Approx(3600.0 * absorbed[o * 2] + 1800.0 * absorbed[(m + o) * 2]).epsilon(1e-6));
  }
  CHECK_FALSE(std::getline(in, line));
  in.clear(), in.seekg(0);
  std::getline(in, line), std::getline(in, line);
  CHECK(split(line)[1] == "shrub, \"big\"");
  CHECK(split(line)[4] == "Stem");
}

TEST_CASE("A result without facets makes a table and no mesh", "[view][export]") {
  const Folder folder;
  const Scene scene = small_scene();
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  {
    ResultWriter writer(folder / "r.h5", scene, placed, {false, {}}, "0.1.0", "flat");
    Values(facets).send(writer, 1000);
    writer.finish(small_report());
  }
  const Result result(folder / "r.h5");
  export_csv(result, folder / "o.csv", silent());
  CHECK_THROWS_WITH(
      export_ply(result, folder / "m.ply", {}, silent()),
      (folder / "r.h5") + ": /facets: found nothing; expected values per facet; the scene kept organs only ([output] facets = false)");
  CHECK(folder.files() == 2);
}
