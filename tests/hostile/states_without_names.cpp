// States that have no names go by their numbers.
#include <catch2/catch.hpp>

#include "run_program.hpp"

TEST_CASE("--state of a result whose one state has no name: its number is said, and taken", "[states]") {
  const TemporaryFolder folder;
  folder.file("p.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const std::string state = "[sun]\nelevation = 40\nazimuth = 10\nirradiance = { P = 1 }\n";
  const std::string scene = folder.file("s.toml", "bands = [\"P\"]\n" + state +
                                                      "[optics.leaf]\nreflectance = { P = 0 }\n[[plant]]\nname = \"p\"\nfile = \"p.obj\"\n"
                                                      "optics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 1] } ]\n");
  const std::string result = folder.path("r.h5");
  REQUIRE(run_sunfleck({"solve", scene, "-o", result, "--method", "direct", "--no-certificate"}).exit_code == 0);
  for (const auto& output : {std::vector<std::string>{"render", result, "-o", folder.path("r.png"), "--width", "16", "--height", "16"},
                             std::vector<std::string>{"export", result, "-o", folder.path("r.ply")}}) {
    auto wrong = output, right = output;
    wrong.insert(wrong.end(), {"--state", "noon"});
    right.insert(right.end(), {"--state", "1"});
    const auto run = run_sunfleck(wrong);
    CHECK(run.exit_code == 2);
    INFO(run.err);
    CHECK(run.err.find("--state: found 'noon'; expected one of those in " + result + ": 1") != std::string::npos);
    CHECK(run_sunfleck(right).exit_code == 0);
  }
}
