// A result that its own certificate contradicts does not look like success.
#include <catch2/catch.hpp>

#include <string>

#include <nlohmann/json.hpp>

#include <sunfleck/result/result_reader.hpp>

#include "reference_runs.hpp"
#include "run_program.hpp"

using namespace sunfleck;

namespace {

/// Two crowns that reach into each other and, as their cell is narrower than they are, into images of themselves: more than method
/// `instantiation` can follow.
std::string tangle() {
  return "bands = [\"PAR\", \"NIR\"]\n[domain]\nperiodic = [0, 0, 0.3, 0.3]\n[sun]\nelevation = 30\nazimuth = 100\n"
         "irradiance = { PAR = 400, NIR = 400 }\n[sky]\nmodel = \"standard_overcast\"\nirradiance = { PAR = 100, NIR = 80 }\n"
         "[optics.leaf]\nreflectance = { PAR = 0.1, NIR = 0.46 }\ntransmittance = { PAR = 0.05, NIR = 0.42 }\n"
         "[ground]\ncells = [4, 4]\nreflectance = { PAR = 0.1, NIR = 0.2 }\n"
         "[[plant]]\nname = \"crown\"\nfile = \"crown.obj\"\noptics = { \"*\" = \"leaf\" }\n"
         "place = [ { position = [0, 0, 0] }, { position = [0.1, 0.1, 0.03], turn = 70 } ]\n";
}

/// Square leaves of 4 cm in .4 m x .4 m x .4 m, one group each.
std::string crown() {
  std::string text;
  int number = 0;
  for (const auto& leaf : reference_runs::leaves(150, 0.04, {0.4, 0.4, 0.4}, 1)) {
    text += "g leaf" + std::to_string(number++) + "\n";
    for (const auto& v : leaf.vertices) text += "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    text += "f -4 -3 -2 -1\n";
  }
  return text;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a method that was asked for and is wrong here: inaccurate, exit 3, everywhere said", "[inaccurate]") {
  const TemporaryFolder folder;
  folder.file("crown.obj", crown());
  const std::string scene = folder.file("tangle.toml", tangle()), result = folder.path("r.h5");
  const auto run = run_sunfleck({"solve", scene, "-o", result, "--method", "instantiation", "--quality", "fine"});
  INFO(run.err << run.out);
  REQUIRE(run.exit_code == 3);
  CHECK(contains(run.err, "sunfleck: inaccurate: the certificate finds "));
  CHECK(contains(run.err, "where quality fine aims at "));
  CHECK(contains(run.err, "The result has status 'inaccurate'. Method 'instantiation' was asked for and is kept"));
  CHECK_FALSE(contains(run.err, "solving again"));
  CHECK(Result(result).header().status == "inaccurate");
  CHECK(Result(result).header().method == "instantiation");

  const auto info = run_sunfleck({"info", result});
  CHECK(contains(info.out, "instantiation, inaccurate (Sunfleck"));
  CHECK(nlohmann::json::parse(run_sunfleck({"info", result, "--json"}).out)["status"] == "inaccurate");
  CHECK(contains(run_sunfleck({"export", result, "-o", folder.path("t.csv")}).err, "r.h5 has status 'inaccurate': its own certificate"));

  // by the choice of the program, the same scene is right
  const auto chosen = run_sunfleck({"solve", scene, "-o", result});
  INFO(chosen.err);
  CHECK(chosen.exit_code == 0);
  CHECK(Result(result).header().status == "converged");

  // without a certificate there is nothing to judge by, and the table says so
  const auto silent = run_sunfleck({"solve", scene, "-o", result, "--method", "instantiation", "--no-certificate"});
  CHECK(silent.exit_code == 0);
  CHECK(contains(silent.out, "not certified: the error of this result is not known"));
}

TEST_CASE("direct light alone is not held against what it leaves out", "[inaccurate]") {
  const TemporaryFolder folder;
  folder.file("crown.obj", crown());
  const std::string scene = folder.file("tangle.toml", tangle());
  CHECK(run_sunfleck({"solve", scene, "-o", folder.path("r.h5"), "--method", "direct", "--quality", "draft"}).exit_code == 0);
}
