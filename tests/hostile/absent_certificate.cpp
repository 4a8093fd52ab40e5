// A solve without a certificate does none of its work.
#include <catch2/catch.hpp>

#include "run_program.hpp"
#include "scene_files.hpp"

TEST_CASE("absent: the certificate", "[absent][cli]") {
  const TemporaryFolder folder;
  folder.file("leaf.obj", sunfleck::two_organs);
  const auto scene =
      folder.file("scene.toml",
                  "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 1.0 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
                  "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0] } ]\n");
  const auto info = [&](std::vector<std::string> more) {
    std::vector<std::string> solve{"solve", scene, "-o", folder.path("r.h5"), "--quality", "draft"};
    solve.insert(solve.end(), more.begin(), more.end());
    REQUIRE(run_sunfleck(solve).exit_code == 0);
    return run_sunfleck({"info", folder.path("r.h5"), "--json"}).out;
  };
  CHECK(info({}).find("\"certificate\"") != std::string::npos);
  CHECK(info({"--no-certificate"}).find("\"certificate\"") == std::string::npos);  // neither rows nor seconds
}
