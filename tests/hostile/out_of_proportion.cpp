// Scenes whose parts are out of all proportion: a clear message at once, no hang, no crash, bounded memory.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include <sys/resource.h>

#include "run_program.hpp"

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// CPU time of all programs that have run so far [s].
double seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string scene(const std::string& rest, const std::string& place = "{ position = [0, 0, 0.5] }") {
  return "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100.0 }\n[sun]\nelevation = 40.0\nazimuth = "
         "100.0\nirradiance = "
         "{ PAR = 10.0 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = "
         "\"leaf\" }\nplace = [ " +
         place + " ]\n" + rest;
}

std::string square(const std::string& side, const std::string& rise) {
  return "v 0 0 0\nv " + side + " 0 0\nv " + side + " " + side + " " + rise + "\nv 0 " + side + " " + rise + "\nf 1 2 3 4\n";
}

const std::string cell = "[domain]\nperiodic = [0, 0, 1, 1]\n[ground]\ncells = [4, 4]\nreflectance = { PAR = 0.1 }\n";

}  // namespace

TEST_CASE("A plant a hundred cells wide is noted, planned and solved with bounded work", "[proportion]") {
  const std::string rise = GENERATE("0", "30");
  const TemporaryFolder folder;
  folder.file("leaf.obj", square("100", rise));
  const std::string file = folder.file("scene.toml", scene(cell));
  const std::vector<std::vector<std::string>> runs{{"plan", file},
                                                   {"solve", file, "-o", folder.path("a.h5"), "--quality", "draft"},
                                                   {"solve", file, "-o", folder.path("b.h5"), "--quality", "draft", "--method", "direct"}};
  for (const auto& arguments : runs) {
    INFO(arguments[0] << " with a leaf that rises by " << rise);
    const double before = seconds_of_children();
    const auto run = run_sunfleck(arguments);
    INFO(run.err);
    CHECK((run.exit_code == 0 || run.exit_code == 3));
    CHECK(contains(run.err, "note: plant \"leaf\" is 100 m by 100 m, and the periodic cell 1 m by 1 m: it covers 10000 cells"));
    CHECK(contains(run.err, "unit"));
    CHECK(seconds_of_children() - before < 60);
  }
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  CHECK(usage.ru_maxrss < 1'000'000);  // kB, of the largest program so far
}

TEST_CASE("Copies of a plant far wider than the cell are left to clustering", "[proportion]") {
  const TemporaryFolder folder;
  std::string leaves;
  for (int i = 0; i < 1500; ++i)
    leaves += "v " + std::to_string(i % 40) + " " + std::to_string(i / 40) + " 0\nv " + std::to_string(i % 40) + ".5 " +
              std::to_string(i / 40) + " 0.2\nv " + std::to_string(i % 40) + " " + std::to_string(i / 40) + ".5 0\nf -3 -2 -1\n";
  folder.file("leaf.obj", leaves);
  const std::string file = folder.file("scene.toml", scene(cell, "{ grid = { origin = [0, 0], step = [0.2, 0.2], count = [5, 5] } }"));
  const auto run = run_sunfleck({"plan", file});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "clustering"));
  CHECK(contains(run.out, "periodic cells, far into images of their own: too much for instantiation"));
}

TEST_CASE("Leaves and sensors at the end of the world are refused by every method", "[proportion]") {
  const std::string method = GENERATE("clustering", "flat", "direct", "reference", "instantiation");
  const TemporaryFolder folder;
  folder.file("leaf.obj", square("1", "0.1"));
  const auto refused = [&](const std::string& text, const std::string& message) {
    const auto run = run_sunfleck({"solve", folder.file("scene.toml", text), "-o", folder.path("a.h5"), "--method", method});
    INFO(method << ": " << run.err);
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, message));
  };
  refused(scene("[domain]\nperiodic = [-1, -1, 1, 1]\n", "{ position = [0, 0, 0.5] }, { position = [0, 0, 9e7] }"),
          "plant[0].place[0]: found a plant of 1 m that stands 4.5e+07 m from the middle of the scene");
  refused(scene("[domain]\nperiodic = [-1, -1, 1, 1]\n", "{ position = [0, 0, 0.5] }, { position = [0, 0, 1e9] }"), "place");
  if (method == "instantiation") return;  // knows no sensors
  refused(scene(cell + "[[sensor]]\nname = \"s\"\ngrid = { z = -1e308, cells = [5, 5], size = [1, 1] }\n"), "grid.z");
  refused(scene("[[sensor]]\nname = \"s\"\ngrid = { z = 0.1, cells = [5, 5], size = [1e18, 1e18] }\n"), "grid.size");
  refused(scene("[[sensor]]\nname = \"s\"\ngrid = { z = 0.1, cells = [5, 5], size = [1e8, 1e8] }\n"), "sensor[0].grid.size: found 5e+07 m");
}
