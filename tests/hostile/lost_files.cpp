// No output takes the place of a file that was read or is named by what was read, whatever verb, spelling or link leads there.
#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <filesystem>

#include "places.hpp"
#include "run_program.hpp"

namespace fs = std::filesystem;

namespace {

const std::string square = "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const std::string photometry = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 90 180\n0\n100 50 0\n";  // a small lamp

/// A folder with a scene that names a file of every kind, and its result.
struct Field {
  TemporaryFolder folder;
  std::string scene, result;
  Field() {
    folder.file("leaf.obj", square);
    folder.file("leaf.mtl", "newmtl green\nKd 0 1 0\n");
    folder.file("ground.obj", "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nf 1 2 3 4\n");
    folder.file("plate.obj", "v 0 0 1\nv .1 0 1\nv .1 .1 1\nf 1 2 3\n");
    folder.file("places.csv", "x,y,z\n0,0,0.5\n");
    folder.file("lamp.ies", photometry);
    folder.file("classes.toml", "[[type]]\nname = \"leaf\"\n");
    scene = folder.file(
        "scene.toml",
        "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100 }\n[optics.leaf]\nreflectance = { PAR = 0.1 }\n"
        "[ground]\nmesh = \"ground.obj\"\nreflectance = { PAR = 0.1 }\n[[plant]]\nname = \"leaf\"\nfile = \"leaf.obj\"\n"
        "optics = { \"*\" = \"leaf\" }\nplace = { file = \"places.csv\" }\n"
        "[[sensor]]\nname = \"plate\"\nmesh = \"plate.obj\"\n");
    result = folder.path("result.h5");
  }
  void solve() const { REQUIRE(run_sunfleck({"solve", scene, "-o", result, "--method", "direct", "--no-certificate"}).exit_code == 0); }

  /// Everything that the folder holds, with its bytes.
  std::string all() const {
    std::string text;
    for (const auto& name : folder.listing()) text += name + "\n" + text_of(folder.path(name));
    return text;
  }
  /// Runs a verb that must refuse, and leave all as it was.
  void refused(const std::vector<std::string>& arguments, const std::string& message) const {
    const std::string before = all();
    const auto run = run_sunfleck(arguments);
    std::string said;
    for (const auto& word : arguments) said += word + " ";
    INFO(said << "\n" << run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find(message) != std::string::npos);
    CHECK(all() == before);
  }
};

}  // namespace

TEST_CASE("solve takes the place of nothing that its scene names, at any depth and by any link", "[cli][lost]") {
  const Field field;
  for (const std::string name : {"leaf.obj", "leaf.mtl", "ground.obj", "plate.obj", "places.csv", "scene.toml"})
    for (const bool hard : {false, true}) {
      INFO(name);
      const std::string result = field.folder.path("result.h5"), input = field.folder.path(name);
      hard ? fs::create_hard_link(input, result) : fs::create_symlink(name, result);
      field.refused({"solve", field.scene, "-o", result}, result + ": found the input file");
      fs::remove(result);
      const std::string picture = field.folder.path("picture.png");
      hard ? fs::create_hard_link(input, picture) : fs::create_symlink(name, picture);
      field.refused({"solve", field.scene, "-o", result, "--picture", picture}, picture + ": found the input file");
      fs::remove(picture);
    }
  const auto run = run_sunfleck({"solve", field.scene, "-o", field.result, "--method", "direct", "--no-certificate"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
}

TEST_CASE("a plant of HDF5 survives the solve of its scene under its own name", "[cli][lost]") {
  const TemporaryFolder folder;
  const std::string plant = folder.path("wheat.h5");
  REQUIRE(run_sunfleck({"generate", SUNFLECK_SOURCE_DIR "/plants/wheat.toml", "-o", plant, "--age", "10"}).exit_code == 0);
  const std::string scene = folder.file("scene.toml",
                                        "bands = [\"PAR\"]\n[sky]\nmodel = \"uniform\"\nirradiance = { PAR = 100 }\n[optics.leaf]\n"
                                        "reflectance = { PAR = 0.1 }\n[[plant]]\nname = \"wheat\"\nfile = \"wheat.h5\"\n"
                                        "optics = { \"*\" = \"leaf\" }\nplace = [ { position = [0, 0, 0] } ]\n");
  const std::string before = text_of(plant);
  const std::string own_name = fs::path(scene).parent_path().filename().string();
  for (const std::string& spelling : std::vector<std::string>{"wheat.h5", "./wheat.h5", "../" + own_name + "/wheat.h5"}) {
    const auto run = run_sunfleck({"solve", scene, "-o", folder.path(spelling)});
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find("wheat.h5: found") != std::string::npos);
    CHECK(text_of(plant) == before);
  }
}

TEST_CASE("exports and pictures take the place of neither the result, its scene, nor its plants", "[cli][lost]") {
  const Field field;
  field.solve();
  const auto path = [&](const std::string& name) { return field.folder.path(name); };
  field.refused({"export", field.result, "-o", path("leaf.obj")}, "leaf.obj: found");
  field.refused({"export", field.result, "-o", path("places.csv")}, "places.csv: found");
  field.refused({"export", field.result, "-o", path("ground.obj")}, "ground.obj: found");
  for (const std::string name : {"leaf.mtl", "scene.toml", "result.h5", "plate.obj"}) {
    fs::create_symlink(name, path("link.csv"));
    field.refused({"export", field.result, "-o", path("link.csv")}, "link.csv: found the input file");
    fs::remove(path("link.csv"));
    fs::create_hard_link(path(name), path("link.png"));
    field.refused({"render", field.result, "-o", path("link.png")}, "link.png: found the input file");
    fs::remove(path("link.png"));
  }
}

TEST_CASE("what is written beside an output takes the place of nothing that is not ours", "[cli][lost]") {
  const Field field;
  field.solve();
  const auto path = [&](const std::string& name) { return field.folder.path(name); };
  const std::string species = SUNFLECK_SOURCE_DIR "/plants/wheat.toml";
  const std::vector<std::string> generate{"generate", species, "-o", path("wheat.obj"), "--age", "10"};
  field.folder.file("wheat.mtl", "newmtl mine\nKd 1 0 0\n");
  field.refused(generate, "wheat.obj: found " + path("wheat.mtl") +
                              ", which is written beside it and is there already, not by sunfleck; expected another name\n");
  field.refused({"export", field.result, "-o", path("wheat.obj")}, "not by sunfleck; expected another name");
  fs::remove(path("wheat.mtl"));
  fs::create_symlink("nowhere", path("wheat.mtl"));
  field.refused(generate, "not by sunfleck; expected another name");
  fs::remove(path("wheat.mtl"));
  fs::copy_file(field.result, path("m.xdmf.h5"));
  field.refused({"export", field.result, "-o", path("m.xdmf")}, "not by sunfleck; expected another name");
  fs::remove(path("m.xdmf.h5"));
  // ours are replaced
  for (int i = 0; i < 2; ++i) {
    CHECK(run_sunfleck(generate).exit_code == 0);
    CHECK(run_sunfleck({"export", field.result, "-o", path("wheat.obj")}).exit_code == 0);
    CHECK(run_sunfleck({"export", field.result, "-o", path("m.xdmf")}).exit_code == 0);
  }
}

TEST_CASE("a full disk leaves neither a plant nor the library beside it", "[cli][lost]") {
  const TemporaryFolder folder;
  for (const std::string name : {"wheat.obj", "wheat.h5"})
    for (const std::size_t bytes : {std::size_t{60}, std::size_t{1000}}) {
      ProgramFate fate;
      fate.disk_bytes = bytes;
      fate.err = "closed";
      fate.out = "/dev/null";
      CHECK(run_sunfleck({"generate", SUNFLECK_SOURCE_DIR "/plants/wheat.toml", "-o", folder.path(name), "--age", "10"}, fate).exit_code ==
            1);
      CHECK(folder.listing().empty());
    }
}

TEST_CASE("import replaces a scene that it wrote, and no other", "[cli][lost][import]") {
  const Field field;
  const std::string can = field.folder.file("plants.can", "p 1 100001001000 3 0 0 1 1 0 1 0 1 1\n"), scene = field.folder.path("new.toml");
  field.refused({"import", can, "-o", field.scene}, "scene.toml: found a scene that import has not written, or that was changed since");
  fs::create_hard_link(can, scene);
  field.refused({"import", can, "-o", scene}, "new.toml: found the input file");
  fs::remove(scene);
  CHECK(run_sunfleck({"import", can, "-o", scene}).exit_code == 0);
  CHECK(run_sunfleck({"import", can, "-o", scene}).exit_code == 0);
  field.folder.file("new.toml", text_of(scene) + "# mine\n");
  field.refused({"import", can, "-o", scene}, "new.toml: found a scene that import has not written, or that was changed since");
}

TEST_CASE("two outputs are two files, and no output is a device or a pipe", "[cli][lost]") {
  const Field field;
  const std::string result = field.folder.path("r.h5"), picture = field.folder.path("p.png");
  fs::create_symlink("r.h5", picture);
  field.refused({"solve", field.scene, "-o", result, "--picture", picture}, picture + ": found the same file as " + result);
  fs::remove(picture);
  REQUIRE(mkfifo(result.c_str(), 0600) == 0);
  ProgramFate fate;
  fate.seconds = 60;
  const auto run = run_sunfleck({"solve", field.scene, "-o", result}, fate);
  CHECK(run.exit_code == 2);
  CHECK(run.err == "sunfleck: " + result + ": found a device or a pipe; expected a file to write\n");
}

TEST_CASE("a pipe in the place of an input is an error, and nothing waits for it", "[cli][lost]") {
  const Field field;
  field.solve();
  ProgramFate fate;
  fate.seconds = 60;
  for (const std::string name : {"leaf.obj", "ground.obj", "places.csv", "scene.toml"}) {
    const std::string input = field.folder.path(name), aside = field.folder.path("aside");
    fs::rename(input, aside);
    REQUIRE(mkfifo(input.c_str(), 0600) == 0);
    const auto run = run_sunfleck({"solve", field.scene, "-o", field.folder.path("new.h5")}, fate);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find(name + ": found a pipe; expected a file\n") != std::string::npos);
    fs::remove(input);
    fs::rename(aside, input);
  }
  const std::string pipe = field.folder.path("pipe.h5");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", pipe},
                                                    {"export", pipe, "-o", field.folder.path("t.csv")},
                                                    {"compare", field.result, pipe},
                                                    {"render", pipe, "-o", field.folder.path("t.png")}}) {
    const auto run = run_sunfleck(arguments, fate);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find("pipe.h5: found a pipe") != std::string::npos);
  }
}
