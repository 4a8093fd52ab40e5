// Methods lattice and occlusion, and previews: what they cannot do is said, and nothing is lost.
#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

#include <sunfleck/result/result_reader.hpp>

#include "run_program.hpp"

using namespace sunfleck;

namespace {

std::string scene(const std::string& light, const std::string& more = "") {
  return "bands = [\"PAR\"]\n" + light +
         "[optics.leaf]\nreflectance = { PAR = 0.1 }\ntransmittance = { PAR = 0.05 }\n[ground]\nsize = [2, 2]\nreflectance = { PAR = 0.1 "
         "}\n"
         "[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\noptics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0] } ]\n" +
         more;
}
const std::string sky = "[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100 }\n";
const std::string sun = "[sun]\nelevation = 40\nazimuth = 100\nirradiance = { PAR = 400 }\n";
const std::string leaf = "v 0 0 .5\nv .2 0 .5\nv .2 .2 .5\nf 1 2 3\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Folder : TemporaryFolder {
  explicit Folder(const std::string& text) : scene_file(file("scene.toml", text)) { file("leaf.obj", leaf); }
  std::string scene_file;
  ProgramRun solve(std::vector<std::string> more) const {
    more.insert(more.begin(), {"solve", scene_file, "-o", path("out.h5"), "--no-certificate"});
    return run_sunfleck(more);
  }
};

}  // namespace

TEST_CASE("a lattice of no nodes, or of a million a side, is refused", "[lattice]") {
  const Folder folder(scene(sky));
  for (const char* nodes : {"0", "1", "1000000", "-3", "many"}) {
    const auto run = folder.solve({"--method", "lattice", "--lattice-nodes", nodes});
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, "--lattice-nodes"));
    CHECK(contains(run.err, nodes));
  }
  CHECK(folder.solve({"--method", "lattice", "--lattice-nodes", "2"}).exit_code == 0);
  const Folder file(scene(sky, "[solve]\nmethod = \"lattice\"\nlattice_nodes = 100000\n"));
  const auto run = file.solve({});
  CHECK(run.exit_code == 2);
  CHECK(contains(run.err, "lattice_nodes"));
  CHECK_FALSE(std::filesystem::exists(file.path("out.h5")));
}

TEST_CASE("a lattice that memory does not hold ends before it begins", "[lattice]") {
  const Folder folder(scene(sky));
  ProgramFate fate;
  fate.memory_bytes = std::size_t{3} << 30;
  const auto run = run_sunfleck(
      {"solve", folder.scene_file, "-o", folder.path("out.h5"), "--no-certificate", "--method", "lattice", "--lattice-nodes", "1024"},
      fate);
  CHECK(run.exit_code == 1);
  CHECK(contains(run.err, "free"));
}

TEST_CASE("unknown mappings and models are refused, with the known ones", "[lattice][occlusion]") {
  const Folder folder(scene(sky));
  const auto mapping = folder.solve({"--method", "lattice", "--lattice-mapping", "papr"});
  CHECK(mapping.exit_code == 2);
  CHECK(contains(mapping.err, "paper"));
  const auto model = folder.solve({"--method", "occlusion", "--occlusion-model", "tabel"});
  CHECK(model.exit_code == 2);
  CHECK(contains(model.err, "table"));
}

TEST_CASE("occlusion without a sky, and sensors with either method, are refused", "[lattice][occlusion]") {
  const Folder dark(scene(sun));
  const auto no_sky = dark.solve({"--method", "occlusion"});
  CHECK(no_sky.exit_code == 2);
  CHECK(contains(no_sky.err, "sky"));
  const Folder sensing(scene(sky, "[[sensor]]\nname = \"s\"\ngrid = { z = 1, cells = [1, 1] }\n"));
  for (const char* method : {"lattice", "occlusion"}) {
    const auto run = sensing.solve({"--method", method});
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, "sensor"));
    CHECK(contains(run.err, method));
  }
}

TEST_CASE("an error cannot be asked of methods that leave light out", "[lattice][occlusion]") {
  const Folder folder(scene(sky));
  for (const char* method : {"lattice", "occlusion"}) {
    const auto run = run_sunfleck({"solve", folder.scene_file, "-o", folder.path("out.h5"), "--method", method, "--error", "2%"});
    CHECK(run.exit_code == 2);
    CHECK(contains(run.err, method));
  }
}

TEST_CASE("plan says what the approximate methods leave out", "[lattice][occlusion]") {
  const Folder folder(scene(sky));
  const auto lattice = run_sunfleck({"plan", folder.scene_file, "--method", "lattice"});
  CHECK(lattice.exit_code == 0);
  CHECK(contains(lattice.out, "no links"));
  CHECK(contains(lattice.out, "nodes of the lattice"));
  const auto occlusion = run_sunfleck({"plan", folder.scene_file, "--method", "occlusion"});
  CHECK(occlusion.exit_code == 0);
  CHECK(contains(occlusion.out, "no elements, links or lines"));
  CHECK(contains(occlusion.out, "shells of crowns"));
}

TEST_CASE("a preview is a picture without a solve", "[preview]") {
  const Folder folder(scene(sun + sky));
  const auto run = run_sunfleck({"preview", folder.scene_file, "-o", folder.path("p.png"), "--width", "64", "--height", "48"});
  CHECK(run.exit_code == 0);
  CHECK(text_of(folder.path("p.png")).substr(1, 3) == "PNG");
  CHECK(folder.listing() == std::vector<std::string>{"leaf.obj", "p.png", "scene.toml"});
  CHECK(run_sunfleck({"preview", folder.scene_file, "-o", folder.path("p.jpg")}).exit_code == 2);
  CHECK(run_sunfleck({"preview", folder.scene_file, "-o", folder.scene_file}).exit_code == 2);
  CHECK(run_sunfleck({"preview", folder.path("none.toml"), "-o", folder.path("q.png")}).exit_code == 2);
  const auto state = run_sunfleck({"preview", folder.scene_file, "-o", folder.path("q.png"), "--state", "noon"});
  CHECK(state.exit_code == 2);
  CHECK(contains(state.err, "noon"));
  // without sky the sun alone, and lamps and sensors are no reason to fail
  const Folder sensing(scene(sun, "[[sensor]]\nname = \"s\"\ngrid = { z = 1, cells = [1, 1] }\n"));
  CHECK(run_sunfleck({"preview", sensing.scene_file, "-o", sensing.path("p.png"), "--width", "64", "--height", "48"}).exit_code == 0);
}

TEST_CASE("a scene is viewed before any solve, and nothing of that stays", "[preview]") {
  const Folder folder(scene(sun + sky));
  std::filesystem::create_directory(folder.path("tmp"));
  ProgramFate fate;
  fate.stop_at = "ready after";
  fate.environment = {"TMPDIR=" + folder.path("tmp")};
  const auto run = run_sunfleck({"view", folder.scene_file}, fate);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.err, "preview, not a solve"));
  CHECK(contains(run.out, "http://127.0.0.1:"));
  CHECK(std::filesystem::is_empty(folder.path("tmp")));
  CHECK(run_sunfleck({"view", folder.path("none.toml")}).exit_code == 2);
}

TEST_CASE("a picture of occlusion's light has no shadow of a sun that is not in it", "[occlusion]") {
  const Folder with_sun(scene(sun + sky)), without(scene(sky));
  for (const auto* folder : {&with_sun, &without}) {
    CHECK(folder->solve({"--method", "occlusion", "--picture", folder->path("a.png")}).exit_code == 0);
    CHECK(run_sunfleck({"render", folder->path("out.h5"), "-o", folder->path("b.png"), "--width", "64", "--height", "48"}).exit_code == 0);
  }
  CHECK(text_of(with_sun.path("a.png")) == text_of(without.path("a.png")));
  CHECK(text_of(with_sun.path("b.png")) == text_of(without.path("b.png")));
}
