// `sunfleck compare` with results that are not of one scene, or of one scene in another light.
#include <catch2/catch.hpp>

#include "run_program.hpp"

namespace {

std::string solved(const TemporaryFolder& folder, const std::string& name, const std::string& height, const std::string& sun) {
  folder.file("leaf.obj", "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nf 1 2 3 4\n");
  const std::string scene =
      folder.file(name + ".toml", "bands = [\"PAR\"]\n[sun]\ndirection = [0, 0, 1]\nirradiance = { PAR = " + sun +
                                      " }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
                                      "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\n"
                                      "place = [ { position = [0, 0, " +
                                      height + "] } ]\n");
  const auto run = run_sunfleck({"solve", scene, "-o", folder.path(name + ".h5"), "--method", "direct", "--no-certificate"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  return folder.path(name + ".h5");
}

}  // namespace

TEST_CASE("results of different scenes are not compared, but on request", "[cli][compare]") {
  const TemporaryFolder folder;
  const std::string low = solved(folder, "low", "1", "100"), high = solved(folder, "high", "1.5", "100");
  const auto refused = run_sunfleck({"compare", low, high});
  CHECK(refused.exit_code == 2);
  CHECK(refused.out.empty());
  CHECK(refused.err == "sunfleck: " + low +
                           ": found facet 0 at (0.0666667, 0.0333333, 1) m; expected (0.0666667, 0.0333333, 1.5) m as in " + high +
                           "; only results of the same scene can be compared\n");
  CHECK(run_sunfleck({"compare", low, high, "--ignore-places"}).exit_code == 0);
  CHECK(run_sunfleck({"render", low, "-o", folder.path("p.png"), "--quantity", "error", "--reference", high}).exit_code == 2);
}

TEST_CASE("what else than the solution differs is said", "[cli][compare]") {
  const TemporaryFolder folder;
  const std::string dim = solved(folder, "dim", "1", "100"), bright = solved(folder, "bright", "1", "200");
  CHECK(run_sunfleck({"compare", dim, bright}).out.find("\nnote       their light differs: sun\n") != std::string::npos);
  CHECK(run_sunfleck({"compare", dim, bright, "--json"}).out.find("\"notes\": [\n    \"their light differs: sun\"\n  ]") !=
        std::string::npos);
  CHECK(run_sunfleck({"compare", dim, dim}).out.find("note") == std::string::npos);
}
