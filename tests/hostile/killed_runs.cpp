// What runs leave that are killed, hung up on, or lose their listeners.
#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <csignal>
#include <filesystem>

#include "run_program.hpp"

namespace fs = std::filesystem;

namespace {

struct Leaf {
  TemporaryFolder folder;
  std::string scene = folder.file("scene.toml",
                                  "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100 }\n[optics.leaf]\n"
                                  "reflectance = { PAR = 0.1 }\n[ground]\nsize = [2, 2]\nreflectance = { PAR = 0.1 }\n"
                                  "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\n"
                                  "optics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0.5] } ]\n"),
              result = folder.path("result.h5");
  Leaf() { folder.file("leaf.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"); }
  std::vector<std::string> long_work() const { return {"solve", scene, "-o", result, "--method", "reference", "--samples", "100000000"}; }
  std::vector<std::string> short_work() const { return {"solve", scene, "-o", result, "--method", "direct", "--no-certificate"}; }
};

ProgramFate stopped_by(int signal) {
  ProgramFate fate;
  fate.stop_at = "read ";
  fate.signal = signal;
  return fate;
}

}  // namespace

TEST_CASE("what a killed run left is removed by the next one of that name, which says so", "[cli][killed]") {
  const Leaf leaf;
  CHECK(run_sunfleck(leaf.long_work(), stopped_by(SIGKILL)).exit_code == 128 + SIGKILL);
  std::string left;
  for (const auto& name : leaf.folder.listing())
    if (name.rfind(".result.h5.partial-", 0) == 0) left = leaf.folder.path(name);
  REQUIRE_FALSE(left.empty());
  const std::string other = leaf.folder.file(".other.h5.partial-00000000-0000000000000000", "x"),
                    like = leaf.folder.file(".result.h5.partial-mine", "x");
  fs::create_symlink("leaf.obj", leaf.folder.path(".result.h5.partial-00000000-0000000000000001"));
  const auto run = run_sunfleck(leaf.short_work());
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(run.err.find("note: removed " + left + ", ") != std::string::npos);
  CHECK(run.err.find(" that a run that was killed had left\n") != std::string::npos);
  CHECK_FALSE(fs::exists(left));
  CHECK(fs::exists(other));
  CHECK(fs::exists(like));
  CHECK(fs::exists(leaf.folder.path("leaf.obj")));
}

TEST_CASE("a hung-up terminal stops a run in order; signals that were ignored stay so", "[cli][killed]") {
  const Leaf leaf;
  const auto before = leaf.folder.listing();
  CHECK(run_sunfleck(leaf.long_work(), stopped_by(SIGHUP)).exit_code == 4);
  CHECK(leaf.folder.listing() == before);
  for (const int signal : {SIGINT, SIGHUP}) {
    auto fate = stopped_by(signal);
    fate.ignored_signal = signal;
    CHECK(run_sunfleck(leaf.short_work(), fate).exit_code == 0);
  }
}

TEST_CASE("a pipe that nobody reads ends no solve", "[cli][killed]") {
  const Leaf leaf;
  ProgramFate fate;
  fate.err = "broken pipe";
  auto work = leaf.short_work();
  CHECK(run_sunfleck(work, fate).exit_code == 0);
  CHECK(run_sunfleck({"info", leaf.result}).exit_code == 0);
  fs::remove(leaf.result);
  work.insert(work.end(), {"--picture", leaf.folder.path("picture.png")});
  fate.out = "broken pipe";
  CHECK(run_sunfleck(work, fate).exit_code == 1);  // its table is lost; what it wrote is not
  CHECK(run_sunfleck({"info", leaf.result}).exit_code == 0);
  CHECK(fs::exists(leaf.folder.path("picture.png")));
}

TEST_CASE("what replaces a file has its permissions; write-protected files and links to devices stay", "[cli][killed]") {
  const Leaf leaf;
  leaf.folder.file("result.h5", "old");
  REQUIRE(chmod(leaf.result.c_str(), 0640) == 0);
  CHECK(run_sunfleck(leaf.short_work()).exit_code == 0);
  struct stat status {};
  REQUIRE(stat(leaf.result.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  fs::remove(leaf.result);
  fs::create_symlink("/dev/null", leaf.result);
  const auto run = run_sunfleck(leaf.short_work());
  CHECK(run.exit_code == 2);
  CHECK(run.err.find("found a device or a pipe; expected a file to write") != std::string::npos);
  CHECK(fs::is_symlink(leaf.result));
}
