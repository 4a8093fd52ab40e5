// Memory that is not there: refused with numbers before it runs out, and one message and exit code wherever it does.
#include <catch2/catch.hpp>

#include "run_program.hpp"
#include "sanitized.hpp"

namespace {

std::string scene(int cells, const std::string& more = "") {
  return "bands = [\"PAR\", \"NIR\"]\n[sun]\nelevation = 50\nazimuth = 100\nirradiance = { PAR = 400, NIR = 400 }\n"
         "[optics.leaf]\nreflectance = { PAR = 0.1, NIR = 0.46 }\ntransmittance = { PAR = 0.05, NIR = 0.42 }\n"
         "[ground]\nsize = [4, 4]\ncells = [" +
         std::to_string(cells) + ", " + std::to_string(cells) + "]\nreflectance = { PAR = 0.1, NIR = 0.2 }\n" + more +
         "[[plant]]\nname = \"p\"\nfile = \"p.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0.5] } ]\n";
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("ground of 8,000 x 8,000 cells is refused with numbers before it is laid out", "[memory]") {
  if (sanitized) return;  // shadow memory takes the address space
  const TemporaryFolder folder;
  folder.file("p.obj", square);
  const std::string big = folder.file("big.toml", scene(8000));
  ProgramFate fate;
  fate.memory_bytes = std::size_t{1} << 30;
  for (const char* method : {"clustering", "flat", "direct", "instantiation", "reference"}) {
    const auto run = run_sunfleck({"solve", big, "-o", folder.path("r.h5"), "--method", method}, fate);
    INFO(method << ": " << run.err);
    CHECK(run.exit_code == 1);
    CHECK(contains(run.err, "sunfleck: not enough memory for "));
    CHECK(contains(run.err, "128000000 facets of the ground take "));
    CHECK(contains(run.err, " of the address space (ulimit -v) are free"));
    CHECK(contains(run.err, "'sunfleck plan' predicts what a scene needs"));
  }
  CHECK(folder.listing() == std::vector<std::string>{"big.toml", "p.obj"});
}

TEST_CASE("what can be laid out and not solved is refused by its plan", "[memory]") {
  if (sanitized) return;
  const TemporaryFolder folder;
  folder.file("p.obj", square);
  const std::string middle = folder.file("middle.toml", scene(400));
  ProgramFate fate;
  fate.memory_bytes = std::size_t{420} << 20;
  const auto run = run_sunfleck({"solve", middle, "-o", folder.path("r.h5"), "--method", "clustering", "--threads", "2"}, fate);
  INFO(run.err);
  CHECK(run.exit_code == 1);
  CHECK(contains(run.err, "sunfleck: not enough memory"));
}

TEST_CASE("wherever memory ends: one message, one exit code, no signal, no file left", "[memory]") {
  if (sanitized) return;
  const TemporaryFolder folder;
  folder.file("p.obj", square);
  const std::string small = folder.file("small.toml", scene(60));
  int done = 0, refused = 0;
  for (const std::size_t mib : {60, 80, 100, 120, 140, 160, 180, 220, 260, 300, 400, 2000}) {
    ProgramFate fate;
    fate.memory_bytes = mib << 20;
    const auto run = run_sunfleck({"solve", small, "-o", folder.path("r.h5"), "--quality", "draft", "--threads", "2"}, fate);
    INFO(mib << " MiB: " << run.exit_code << " " << run.err);
    if (run.exit_code == 127) continue;  // the program itself does not load
    CHECK((run.exit_code == 0 || run.exit_code == 1));
    if (run.exit_code == 1) CHECK(contains(run.err, "not enough memory"));
    if (run.exit_code == 1) CHECK(folder.listing() == std::vector<std::string>{"p.obj", "small.toml"});
    if (run.exit_code == 0) std::remove(folder.path("r.h5").c_str());
    ++(run.exit_code == 0 ? done : refused);
  }
  CHECK(done > 0);
  CHECK(refused > 0);
}
