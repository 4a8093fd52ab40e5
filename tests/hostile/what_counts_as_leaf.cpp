// fAPAR counts what the user calls leaves; the balance closes over everything.
#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <sunfleck/result/plant_shares.hpp>
#include <sunfleck/result/result_reader.hpp>

#include "run_program.hpp"

using namespace sunfleck;

namespace {

/// A black wall of 1 m^2 above half of a black leaf of 2 m^2, the sun in the zenith: each absorbs 100 W.
std::string scene(const std::string& of_wall) {
  return "bands = [\"P\"]\n[sun]\ndirection = [0, 0, 1]\nirradiance = { P = 100 }\nangular_diameter = 0\n"
         "[optics.leaf]\nreflectance = { P = 0 }\n[optics.wall]\nreflectance = { P = 0 }\n" +
         of_wall +
         "[[plant]]\nname = \"maize\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 1] } ]\n"
         "[[plant]]\nname = \"house\"\nfile = \"wall.obj\"\noptics = { \"*\" = \"wall\" }\nplace = [ { position = [0, 0, 2] } ]\n";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("counts_as = other leaves a wall out of the absorbed fraction and in the balance, by every method", "[fapar]") {
  const TemporaryFolder folder;
  folder.file("leaf.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
  folder.file("wall.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const std::string all = folder.file("all.toml", scene("")), leaves = folder.file("leaves.toml", scene("counts_as = \"other\"\n"));
  for (const char* method : {"clustering", "flat", "direct", "instantiation", "reference"}) {
    INFO(method);
    for (const bool other : {false, true}) {
      const auto run = run_sunfleck({"solve", other ? leaves : all, "-o", folder.path("r.h5"), "--method", method, "--no-certificate"});
      INFO(run.err << run.out);
      REQUIRE(run.exit_code == 0);
      const Result result(folder.path("r.h5"));
      const auto balance = result.balance()[0][0];
      CHECK(balance.leaves == Approx(200).epsilon(0.03));  // all plant facets
      CHECK(balance.residual() == Approx(0).margin(0.03 * 200));
      CHECK(result.all<double>("balance/absorbed_fraction_leaves")[0] == Approx(other ? 0.5 : 1.0).epsilon(0.03));
      CHECK(result.all<double>("balance/other")[0] == Approx(other ? 100 : 0).epsilon(0.03));
      const auto shares = plant_shares(result);
      REQUIRE(shares);
      CHECK(shares->names == std::vector<std::string>{"maize", "house"});
      CHECK(shares->leaf[0] == Approx(100).epsilon(0.03));
      CHECK((other ? shares->other : shares->leaf)[1] == Approx(100).epsilon(0.03));
      CHECK(contains(run.out, "absorbed by plant, fractions of the incident light"));
      CHECK(contains(run.out, "house (other)") == other);
      const auto info = nlohmann::json::parse(run_sunfleck({"info", folder.path("r.h5"), "--json"}).out);
      CHECK(info["absorbed_by_plant"][1]["name"] == "house");
    }
  }
}

TEST_CASE("counts_as has two values", "[fapar]") {
  const TemporaryFolder folder;
  folder.file("leaf.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
  folder.file("wall.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const auto run = run_sunfleck({"solve", folder.file("s.toml", scene("counts_as = \"wood\"\n")), "-o", folder.path("r.h5")});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "s.toml:10: optics.wall.counts_as: found \"wood\"; expected \"leaf\" or \"other\""));
}
