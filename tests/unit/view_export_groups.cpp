#include <catch2/catch.hpp>

#include <fstream>
#include <map>
#include <sstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/view/copy_values.hpp>
#include <sunfleck/view/export.hpp>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

/// The small scene with an attribute: the stem's cultivar is inherited by its leaves, but for the flag leaf, which has its own.
struct Stored {
  Stored() : scene(small_scene(40)) {
    auto plant = std::make_shared<Plant>(*scene.plants[0].plant);
    set_attribute(*plant, 1, "cultivar", std::string("a, \"b\""));
    set_attribute(*plant, 1, "rank", std::int64_t{10});
    set_attribute(*plant, 3, "rank", std::int64_t{9});
    scene.plants[0].plant = plant;
    facets = expand(scene);
    const PlacedScene copies = place(scene);
    ResultWriter writer(folder / "r.h5", scene, copies, OutputChoice{}, "0.1.0", "flat");
    Values(facets).send(writer, 1000);
    writer.finish(small_report());
  }
  Folder folder;
  Scene scene;
  FacetScene facets;
};

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  explicit Table(const std::string& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      std::vector<std::string> fields(1);
      bool quoted = false;
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
          fields.back() += line[++i];
        else if (line[i] == '"')
          quoted = !quoted;
        else if (line[i] == ',' && !quoted)
          fields.emplace_back();
        else
          fields.back() += line[i];
      }
      if (names.empty())
        names = fields;
      else
        rows.push_back(fields);
    }
  }
  std::size_t column(const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    REQUIRE(at != names.end());
    return static_cast<std::size_t>(at - names.begin());
  }
  double number(std::size_t row, const std::string& name) const { return std::stod(rows.at(row).at(column(name))); }
  std::vector<std::string> texts(const std::string& name) const {
    std::vector<std::string> out;
    for (const auto& row : rows) out.push_back(row.at(column(name)));
    return out;
  }
  double sum(const std::string& name) const {
    double total = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) total += number(r, name);
    return total;
  }
};

}  // namespace

TEST_CASE("Organs are summed by what they have in common", "[view][export][groups]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  Progress progress;
  const auto file = stored.folder / "t.csv";
  const std::size_t m = result.organ_count();
  const auto absorbed = result.all<float>("organs/absorbed"), irradiance = result.all<float>("organs/irradiance"),
             area = result.all<float>("organs/area");
  const OrganTable organs = result.organs();

  SECTION("by type") {
    export_groups(result, file, "type", progress);
    const Table table(file);
    CHECK(table.texts("type") == std::vector<std::string>{"Stem", "Leaf", "ground"});
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      double count = 0, power = 0, sum_area = 0, front = 0, energy = 0;
      for (std::size_t o = 0; o < m; ++o) {
        if (organs.types[organs.type[o]] != table.rows[r][0]) continue;
        count += 1, sum_area += area[o];
        power += absorbed[(m + o) * 2 + 1];                            // evening, NIR
        front += double{area[o]} * irradiance[((m + o) * 2 + 0) * 2];  // evening, front, PAR
        energy += 3600.0 * absorbed[o * 2] + 1800.0 * absorbed[(m + o) * 2];
      }
      CHECK(table.number(r, "organs") == count);
      CHECK(table.number(r, "area_m2") == Approx(sum_area).epsilon(1e-6));  // printed as floats
      CHECK(table.number(r, "absorbed_W_NIR_evening") == Approx(power).epsilon(1e-6));
      CHECK(table.number(r, "irradiance_front_PAR_evening") == Approx(front / sum_area).epsilon(1e-6));
      CHECK(table.number(r, "absorbed_J_PAR") == Approx(energy).epsilon(1e-6));
    }
  }
  SECTION("by several keys, sorted by the first, then the second") {
    export_groups(result, file, "plant,type", progress);
    const Table table(file);
    CHECK(table.texts("plant") == std::vector<std::string>{"shrub", "shrub", "dark", "dark", "ground"});
    CHECK(table.texts("type") == std::vector<std::string>{"Stem", "Leaf", "Stem", "Leaf", "ground"});
    CHECK(table.sum("organs") == double(m));
  }
  SECTION("by order of branching: stems are axes") {
    export_groups(result, file, "order", progress);
    const Table table(file);
    CHECK(table.texts("order") == std::vector<std::string>{"1", ""});
  }
  SECTION("by an attribute, inherited from above; numbers in rising order") {
    export_groups(result, file, "rank", progress);
    const Table table(file);
    CHECK(table.texts("rank") == std::vector<std::string>{"9", "10", ""});
    CHECK(table.number(0, "organs") == 3);  // one flag leaf in each of three copies
    CHECK(table.number(1, "organs") == 3 * 40);
    export_groups(result, file, "cultivar", progress);
    CHECK(Table(file).texts("cultivar") == std::vector<std::string>{"a, \"b\"", ""});
  }
  SECTION("by layers of height, which hold plant facets") {
    const auto corners = stored.facets.corners;
    export_groups(result, file, "layer:0.5", progress);
    const Table table(file);
    CHECK(table.sum("facets") == double(stored.facets.plant_facets));
    const auto facet_absorbed = result.all<float>("facets/absorbed");
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const double low = table.number(r, "z_low_m"), high = table.number(r, "z_high_m");
      CHECK(high - low == Approx(0.5));
      CHECK(std::fabs(std::remainder(low, 0.5)) < 1e-9);
      double power = 0, count = 0;
      for (std::size_t f = 0; f < stored.facets.plant_facets; ++f) {
        const double z = (corners[f][0].z + corners[f][1].z + corners[f][2].z) / 3;
        if (z < low || z >= high) continue;
        count += 1, power += double{stored.facets.area[f]} * facet_absorbed[f * 2];
      }
      CHECK(table.number(r, "facets") == count);
      CHECK(table.number(r, "absorbed_W_PAR_noon") == Approx(power).epsilon(1e-6));
    }
    export_groups(result, file, "layer", progress);
    CHECK(Table(file).rows.size() <= 20);
    CHECK(Table(file).sum("facets") == double(stored.facets.plant_facets));
    export_groups(result, file, "type,layer:1", progress);
    CHECK(Table(file).sum("facets") == double(stored.facets.plant_facets));
    CHECK(Table(file).rows[0][0] == "Stem");
  }
  SECTION("keys that are none") {
    const auto message = [&](const std::string& by) {
      try {
        export_groups(result, file, by, progress);
      } catch (const UsageError& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    CHECK(message("rnak") ==
          "--by: found 'rnak'; expected one of plant, placement, type, name, layer, order, cultivar, rank (did you mean 'rank'?)");
    CHECK(message("layer:-1") == "--by: found 'layer:-1'; expected a depth above zero in metres, such as 'layer:0.5'");
    CHECK(message("type,") == "--by: found an empty name; expected plant, type, layer, order or an attribute, separated by commas");
    CHECK(message("layer,layer:2") == "--by: found two layers; expected one");
    CHECK(stored.folder.files() == 1);
  }
}

TEST_CASE("Attributes of structures are kept in results", "[result][export]") {
  const Stored stored;
  const auto geometry = Result(stored.folder / "r.h5").geometry();
  const Plant& plant = *geometry.plants[0].plant;
  REQUIRE(plant.attribute(3, "rank"));
  CHECK(std::get<std::int64_t>(*plant.attribute(3, "rank")) == 9);
  CHECK(std::get<std::string>(*plant.attribute(1, "cultivar")) == "a, \"b\"");
  CHECK_FALSE(plant.attribute(2, "rank"));
  CHECK_FALSE(geometry.plants[1].plant->attribute(1, "rank"));
}

TEST_CASE("The light on one copy, by structure", "[view][export]") {
  const Stored stored;
  const Result result(stored.folder / "r.h5");
  const auto geometry = result.geometry();
  Progress progress;
  const auto copy = copy_values(result, geometry, std::string("row[0]/shrub[0]"), progress);
  CHECK(copy.plant == 0);
  CHECK(copy.names.front() == "area_m2");
  CHECK(copy.names.back() == "absorbed_J_NIR");
  const OrganTable organs = result.organs();
  const auto absorbed = result.all<float>("organs/absorbed");
  const auto column = std::find(copy.names.begin(), copy.names.end(), "absorbed_W_NIR_evening") - copy.names.begin();
  std::size_t organs_of_copy = 0;
  for (std::size_t o = 0; o < organs.size(); ++o) {
    if (organs.placements[organs.placement[o]] != copy.placement) continue;
    ++organs_of_copy;
    CHECK(copy.values[static_cast<std::size_t>(column)][organs.structure[o]] == double{absorbed[(organs.size() + o) * 2 + 1]});
  }
  CHECK(organs_of_copy == 41);
  CHECK(std::isnan(copy.values[0][0]));  // the plant itself is no organ
  CHECK_THROWS_WITH(copy_values(result, geometry, std::nullopt, progress),
                    "--copy: found nothing; expected one of shrub[0], shrub[1], row[0]/dark[0], row[0]/shrub[0]");
  CHECK_THROWS_WITH(
      copy_values(result, geometry, std::string("shrub[2]"), progress),
      "--copy: found 'shrub[2]'; expected one of shrub[0], shrub[1], row[0]/dark[0], row[0]/shrub[0] (did you mean 'shrub[0]'?)");
}
