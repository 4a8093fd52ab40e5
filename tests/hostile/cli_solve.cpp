// What `sunfleck solve` does with bad scenes, full disks and signals: exit codes, messages, and nothing under the result's name.
#include <catch2/catch.hpp>

#include <csignal>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A scene of one square leaf over ground; the parts that tests break are arguments.
std::string scene(const std::string& leaf = "reflectance = { PAR = 0.1, NIR = 0.4 }\ntransmittance = { PAR = 0.05, NIR = 0.4 }",
                  const std::string& sun = "direction = [0.0, 0.3, 0.9]\nirradiance = { PAR = 400.0, NIR = 400.0 }",
                  const std::string& file = "leaf.obj", const std::string& rest = "") {
  return "bands = [\"PAR\", \"NIR\"]\n[sun]\n" + sun +
         "\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100.0, NIR = 80.0 }\n[optics.leaf]\n" + leaf +
         "\n[ground]\nsize = [2.0, 2.0]\ncells = [4, 4]\nreflectance = { PAR = 0.1, NIR = 0.2 }\n[[plant]]\nname = \"leaf\"\nfile = \"" +
         file + "\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0.5] } ]\n" + rest;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

const std::string old_result = "an older result";

struct Broken {
  std::string what;
  std::string scene_text;
  std::string message;  ///< a part of standard error: file and line or key
  std::string name = "leaf.obj", content = square;
};

const std::string good_leaf = "reflectance = { PAR = 0.1, NIR = 0.4 }\ntransmittance = { PAR = 0.05, NIR = 0.4 }";
const std::string good_sun = "direction = [0.0, 0.3, 0.9]\nirradiance = { PAR = 400.0, NIR = 400.0 }";

std::vector<Broken> broken_scenes() {
  return {
      {"rho + tau above 1", scene("reflectance = { PAR = 0.1, NIR = 0.7 }\ntransmittance = { PAR = 0.05, NIR = 0.4 }"),
       "scene.toml:9: optics.leaf.reflectance.NIR: found reflectance 0.7 + transmittance 0.4"},
      {"negative optics", scene("reflectance = { PAR = -0.1, NIR = 0.4 }"), "scene.toml:9"},
      {"optics without a band", scene("reflectance = { PAR = 0.1 }"), "NIR"},
      {"misspelt key", scene("reflectence = { PAR = 0.1, NIR = 0.4 }"), "reflectance"},
      {"missing file", scene(good_leaf, good_sun, "laef.obj"), "laef.obj"},
      {"zero sun vector", scene(good_leaf, "direction = [0, 0, 0]\nirradiance = { PAR = 400.0, NIR = 400.0 }"), "scene.toml:3"},
      {"broken TOML", scene() + "[sky\n", "scene.toml:"},
      {"a method that does not exist", scene(good_leaf, good_sun, "leaf.obj", "[solve]\nmethod = \"radiance\"\n"),
       "clustering, flat, direct, lattice, occlusion, reference"},
      {"NaN vertex", scene(), "leaf.obj:2", "leaf.obj", "v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n"},
      {"index out of range", scene(), "leaf.obj:4", "leaf.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n"},
      {"empty mesh", scene(), "leaf.obj", "leaf.obj", ""},
      {"broken XML", scene(good_leaf, good_sun, "leaf.opf"), "leaf.opf", "leaf.opf", "<opf version=\"2.0\"><mesh"},
      {"broken PLY", scene(good_leaf, good_sun, "leaf.ply"), "leaf.ply", "leaf.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"},
      {"broken HDF5", scene(good_leaf, good_sun, "leaf.h5"), "leaf.h5", "leaf.h5", "\x89HDF\r\n\x1a\nnothing more"},
  };
}

}  // namespace

TEST_CASE("bad input exits with 2, names its place and leaves the old result alone", "[cli][solve]") {
  for (const Broken& broken : broken_scenes()) {
    INFO(broken.what);
    const TemporaryFolder folder;
    const std::string scene_file = folder.file("scene.toml", broken.scene_text), result = folder.file("result.h5", old_result);
    folder.file(broken.name, broken.content);
    const auto before = folder.listing();
    const ProgramRun run = run_sunfleck({"solve", scene_file, "-o", result});
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK(contains(run.err, broken.message));
    CHECK(text_of(result) == old_result);
    CHECK(folder.listing() == before);
  }
}

TEST_CASE("files that are directories, and outputs that cannot be, are refused before any work", "[cli][solve]") {
  const TemporaryFolder folder;
  const std::string scene_file = folder.file("scene.toml", scene());
  folder.file("leaf.obj", square);
  const std::string here = folder.path(".");
  CHECK(run_sunfleck({"solve", here, "-o", folder.path("r.h5")}).exit_code == 2);
  CHECK(run_sunfleck({"solve", scene_file, "-o", here}).exit_code == 2);
  CHECK(run_sunfleck({"solve", scene_file, "-o", folder.path("none/r.h5")}).exit_code == 2);
  const ProgramRun suffix = run_sunfleck({"solve", scene_file, "-o", folder.path("r.txt")});
  CHECK(suffix.exit_code == 2);
  CHECK(suffix.err == "sunfleck: " + folder.path("r.txt") + ": found suffix '.txt'; expected .h5, .hdf5\n");
  CHECK(folder.listing() == std::vector<std::string>{"leaf.obj", "scene.toml"});
}

TEST_CASE("numbers out of range and unknown names say what was expected", "[cli][solve]") {
  const auto message = [](std::vector<std::string> more) {
    std::vector<std::string> arguments{"solve", "s.toml", "-o", "r.h5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_sunfleck(arguments);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    return run.err;
  };
  const std::string see = "\nsee 'sunfleck solve --help'\n";
  CHECK(message({"--threads", "-1"}) == "sunfleck solve: --threads: found '-1'; expected a whole number from 0 to 4096" + see);
  CHECK(message({"--threads", "two"}) == "sunfleck solve: --threads: found 'two'; expected a whole number from 0 to 4096" + see);
  CHECK(message({"--error", "nan"}) ==
        "sunfleck: --error: found 'nan'; expected per cent, such as 2%, or a fraction, such as 0.02: from 0.0001 to 0.5\n");
  CHECK(message({"--quality", "fin"}) ==
        "sunfleck solve: --quality: found 'fin'; expected one of draft, standard, fine (did you mean 'fine'?)" + see);
  CHECK(message({"--qualty", "fine"}) ==
        "sunfleck solve: unknown option '--qualty'; did you mean '--quality'?\nsunfleck solve: unexpected argument 'fine'" + see);
  CHECK(run_sunfleck({"slove"}).err.rfind("sunfleck: unknown verb 'slove'; did you mean 'solve'?\n", 0) == 0);
}

TEST_CASE("a sun below the horizon and facets without area are notes, not errors", "[cli][solve]") {
  const TemporaryFolder folder;
  const std::string scene_file =
      folder.file("scene.toml", scene(good_leaf, "elevation = -5.0\nazimuth = 90.0\nirradiance = { PAR = 0.0, NIR = 0.0 }"));
  folder.file("leaf.obj", square + "f 1 2 2\n");
  const ProgramRun run = run_sunfleck({"solve", scene_file, "-o", folder.path("r.h5"), "--no-certificate"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err, "below the horizon"));
  CHECK(contains(run.err, "note: 1 facet has no area: kept as rows of zeros, not traced\n"));
  CHECK(folder.listing() == std::vector<std::string>{"leaf.obj", "r.h5", "scene.toml"});
}

TEST_CASE("a run that is stopped leaves the old result as it was", "[cli][solve]") {
  const TemporaryFolder folder;
  const std::string scene_file = folder.file("scene.toml", scene()), result = folder.file("result.h5", old_result);
  folder.file("leaf.obj", square);
  const auto before = folder.listing();
  ProgramFate fate;
  fate.stop_at = "read ";
  const std::vector<std::string> long_work{"solve", scene_file, "-o", result, "--method", "reference", "--samples", "100000000"};
  for (const int signal : {SIGTERM, SIGINT}) {
    fate.signal = signal;
    const ProgramRun run = run_sunfleck(long_work, fate);
    INFO(run.err);
    CHECK(run.exit_code == 4);
    CHECK(contains(run.err, "stopped"));
    CHECK(text_of(result) == old_result);
    CHECK(folder.listing() == before);
  }
  fate.signal = SIGKILL;
  CHECK(run_sunfleck(long_work, fate).exit_code == 128 + SIGKILL);
  CHECK(text_of(result) == old_result);
}

TEST_CASE("a full disk is an error of the output and leaves the old result as it was", "[cli][solve]") {
  const TemporaryFolder folder;
  const std::string scene_file = folder.file("scene.toml", scene()), result = folder.file("result.h5", old_result);
  folder.file("leaf.obj", square);
  const auto before = folder.listing();
  ProgramFate fate;
  fate.disk_bytes = 8192;
  const ProgramRun run = run_sunfleck({"solve", scene_file, "-o", result, "--no-certificate"}, fate);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK(contains(run.err, "result.h5"));
  CHECK(text_of(result) == old_result);
  CHECK(folder.listing() == before);
}
