// `sunfleck originals` and `sunfleck policy` as their user meets them.
#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include "run_program.hpp"

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Two copies of one leaf.
std::string scene(const std::string& policy = "") {
  return "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100.0 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
         "transmittance = { PAR = 0.05 }\n[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\n" +
         policy + "optics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 1] }, { position = [3, 0, 1] } ]\n";
}
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// Coarse, so that tests are quick.
const std::string coarse = "[tables]\nerror = 0.05\n";

struct Files {
  explicit Files(const std::string& policy = coarse) {
    path = folder.file("scene.toml", scene("policy = \"p.toml\"\n"));
    folder.file("leaf.obj", square);
    folder.file("p.toml", policy);
  }
  TemporaryFolder folder;
  std::string path;
};

}  // namespace

TEST_CASE("originals shows classes and tables; a second run measures nothing", "[cli]") {
  const Files files;
  const std::string cache = files.folder.path("cache");
  const auto first = run_sunfleck({"originals", files.path, "--cache", cache});
  CHECK(first.exit_code == 0);
  CHECK(contains(first.out, "plant: all copies of \"leaf\""));
  CHECK(contains(first.out, "exact           1        2         2          1  leaf"));
  CHECK(contains(first.out, "stored"));
  const auto second = run_sunfleck({"originals", files.path, "--cache", cache, "--threads", "1"});
  CHECK(contains(second.out, "found"));
  CHECK(contains(second.err, " 0 rays"));
  // The same tables, but for what the cache did.
  const auto table = [](const std::string& text) { return text.substr(0, text.rfind(' ')); };
  CHECK(table(first.out) == table(second.out));
  const auto json = run_sunfleck({"originals", files.path, "--cache", cache, "--json"});
  CHECK(json.exit_code == 0);
  for (const char* key :
       {"\"cache\": \"found\"", "\"sampling_error\"", "\"fit_residual\"", "\"energy_residual\"", "\"transmittance_mean\""})
    CHECK(contains(json.out, key));
}

TEST_CASE("A cache that cannot be written is a note, and the work is done", "[cli]") {
  const Files files;
  const auto run = run_sunfleck({"originals", files.path, "--cache", files.path + "/cache"});
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err, "/cache cannot be made: Not a directory; originals are measured without it"));
  CHECK(contains(run.out, "unsaved"));
  ProgramFate full;
  full.disk_bytes = 1500;  // an entry is larger, the table on standard output, a file too, is not
  const auto crowded = run_sunfleck({"originals", files.path, "--cache", files.folder.path("full")}, full);
  CHECK(crowded.exit_code == 0);
  CHECK(contains(crowded.err, "/full cannot be written: File too large; originals are measured without it"));
  CHECK(contains(crowded.out, "unsaved"));
  CHECK(std::filesystem::is_empty(files.folder.path("full")));
}

TEST_CASE("Processes that share a cache all find sound entries", "[cli]") {
  const Files files;
  const std::string cache = files.folder.path("cache");
  ProgramRun a, b;
  std::thread other([&] { a = run_sunfleck({"originals", files.path, "--cache", cache, "--threads", "1"}); });
  b = run_sunfleck({"originals", files.path, "--cache", cache, "--threads", "1"});
  other.join();
  CHECK(a.exit_code == 0);
  CHECK(b.exit_code == 0);
  CHECK(std::distance(std::filesystem::directory_iterator(cache), std::filesystem::directory_iterator()) == 1);
  CHECK(contains(run_sunfleck({"originals", files.path, "--cache", cache}).out, "found"));
}

TEST_CASE("originals that are stopped keep what was complete and leave no damaged cache", "[cli]") {
  const Files files;
  files.folder.file("slow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  files.folder.file("slow.toml", "[tables]\nerror = 0.0001\n");
  const std::string two = files.folder.file(
      "two.toml", scene("policy = \"p.toml\"\n") +
                      "[[plant]]\nname = \"slow\"\nfile = \"slow.obj\"\npolicy = \"slow.toml\"\noptics = { \"*\" = \"leaf\" }\n"
                      "place = [ { position = [0, 0, 1] }, { position = [3, 0, 1] } ]\n");
  const std::string cache = files.folder.path("cache");
  ProgramFate fate;
  fate.stop_at = "\"leaf\": 2 facets";  // the first is done, the second begun
  const auto run = run_sunfleck({"originals", two, "--cache", cache}, fate);
  CHECK(run.exit_code == 4);
  std::size_t complete = 0;
  for (const auto& entry : std::filesystem::directory_iterator(cache)) {
    CHECK(entry.path().extension() == ".original");
    ++complete;
  }
  CHECK(complete == 1);
  CHECK(contains(run_sunfleck({"originals", files.path, "--cache", cache}).out, "found"));
}

TEST_CASE("Bad policies and calls end with code 2 and say where", "[cli]") {
  const Files unknown("[type.organ]\nparameter = {}\n");
  auto run = run_sunfleck({"originals", unknown.path, "--no-tables"});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "p.toml:2: type.organ.parameter: unknown key; did you mean \"parameters\"?"));
  const Files lacking("[type.organ]\nparameters = { leafs = [1, 2] }\n");
  run = run_sunfleck({"originals", lacking.path, "--no-tables"});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "p.toml:2: type.organ.parameters.leafs"));
  run = run_sunfleck({"originals", lacking.path, "--cache", "x", "--no-cache"});
  CHECK(run.exit_code == 2);
  run = run_sunfleck({"policy", lacking.path, "--likeness", "0.2"});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "--likeness belongs to --suggest"));
  run = run_sunfleck({"policy", lacking.path, "--suggest"});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "no structure type with 6 structures or more"));
}

TEST_CASE("policy prints what is in use, and it reads back", "[cli]") {
  const Files files;
  const auto run = run_sunfleck({"policy", files.path});
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "error = 0.05\nfield_pixels = 8\n"));
  const std::string copy = files.folder.file("copy.toml", run.out);
  CHECK(run_sunfleck({"originals", files.path, "--policy", copy, "--no-tables"}).exit_code == 0);
}
