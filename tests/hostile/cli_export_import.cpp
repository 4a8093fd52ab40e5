// `sunfleck export` and `sunfleck import` as their users run them.
#include <catch2/catch.hpp>

#include <run_program.hpp>

namespace {

const std::string can =
    "p 1 100001001000 3 0 0 100 30 0 100 0 30 100\np 1 100001002000 3 10 10 80 40 10 80 10 40 85\np 1 100001000000 3 20 20 0 21 20 0 20 20 "
    "80\n";
const std::string par = "n 1\ns d 0.15\ne d 0.10   d 0.11 0.05  d 0.11 0.05\n";

}  // namespace

TEST_CASE("a CARIBU case is imported, solved as it is, and exported in every format", "[cli][import][export]") {
  const TemporaryFolder folder;
  const auto plants = folder.file("plants.can", can), optics = folder.file("par.opt", par),
             light = folder.file("zenith.light", "1 0 0 -1\n"), cell = folder.file("cell.8", "0 0\n50 50\n");
  const auto scene = folder.path("scene.toml"), result = folder.path("r.h5");
  const auto imported = run_sunfleck({"import", plants, optics, light, cell, "--unit", "cm", "--soil", "-o", scene});
  INFO(imported.err);
  REQUIRE(imported.exit_code == 0);
  const auto solved = run_sunfleck({"solve", scene, "-o", result, "--quality", "draft", "--no-certificate"});
  INFO(solved.err);
  REQUIRE(solved.exit_code == 0);
  for (const std::string name : {"m.ply", "m.obj", "m.glb", "m.vtkhdf", "m.xdmf", "organs.csv", "plant.opf"}) {
    const auto run = run_sunfleck({"export", result, "-o", folder.path(name)});
    INFO(name << ": " << run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.empty());
    CHECK(text_of(folder.path(name)).size() > 100);
  }
  const auto table = run_sunfleck({"export", result, "-o", folder.path("types.csv"), "--by", "type"});
  CHECK(table.exit_code == 0);
  CHECK(text_of(folder.path("types.csv")).rfind("type,organs,area_m2,absorbed_W_PAR", 0) == 0);
}

TEST_CASE("options of export that do not belong together are refused, and nothing is written", "[cli][export]") {
  const TemporaryFolder folder;
  const auto plants = folder.file("plants.can", can);
  const auto scene = folder.path("scene.toml"), result = folder.path("r.h5");
  REQUIRE(run_sunfleck({"import", plants, "-o", scene}).exit_code == 0);
  REQUIRE(run_sunfleck({"solve", scene, "-o", result, "--method", "direct", "--no-certificate"}).exit_code == 0);
  const auto before = folder.listing();
  const auto refused = [&](const std::vector<std::string>& options, const std::string& message) {
    std::vector<std::string> arguments{"export", result};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto run = run_sunfleck(arguments);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find(message) != std::string::npos);
    INFO(run.err);
    CHECK(folder.listing() == before);
  };
  refused({"-o", folder.path("m.ply"), "--by", "type"}, "--by: found with a mesh; it belongs to tables (.csv)");
  refused({"-o", folder.path("t.csv"), "--copy", "x"}, "--copy, --original: found without an .opf to write");
  refused({"-o", folder.path("t.csv"), "--by", "tpye"}, "did you mean 'type'?");
  refused({"-o", folder.path("p.opf"), "--band", "PAR"}, "--quantity, --band, --state, --by: an .opf holds every number of its organs");
  refused({"-o", folder.path("p.opf"), "--copy", "plants[7]"}, "--copy: found 'plants[7]'; expected one of plants[0]");
  refused({"-o", folder.path("p.opf"), "--original", folder.path("none.opf")}, "none.opf: found no such file; expected an existing file");
  refused({"-o", folder.path("m.stl")}, "found suffix '.stl'; expected .ply, .obj, .glb, .vtkhdf, .xdmf, .csv, .opf");
}

TEST_CASE("a full disk leaves no part of an export", "[cli][export]") {
  const TemporaryFolder folder;
  const auto plants = folder.file("plants.can", can);
  const auto scene = folder.path("scene.toml"), result = folder.path("r.h5");
  REQUIRE(run_sunfleck({"import", plants, "-o", scene}).exit_code == 0);
  REQUIRE(run_sunfleck({"solve", scene, "-o", result, "--method", "direct", "--no-certificate"}).exit_code == 0);
  const auto before = folder.listing();
  for (const std::string name : {"m.ply", "m.obj", "m.glb", "m.vtkhdf", "m.xdmf", "organs.csv", "plant.opf"}) {
    ProgramFate fate;
    fate.disk_bytes = 200;  // less than any of these, more than the message, which goes to a file here
    const auto run = run_sunfleck({"export", result, "-o", folder.path(name)}, fate);
    INFO(name << ": " << run.err);
    CHECK(run.exit_code == 1);
    CHECK(folder.listing() == before);
  }
}

TEST_CASE("what cannot be imported leaves no scene", "[cli][import]") {
  const TemporaryFolder folder;
  const auto bad = folder.file("bad.ops", "1 1 gone.opf 0 0 0 1 0 0 0\n");
  const auto before = folder.listing();
  const auto run = run_sunfleck({"import", bad, "-o", folder.path("scene.toml")});
  CHECK(run.exit_code == 2);
  CHECK(run.err.find("bad.ops:1: found no file") != std::string::npos);
  CHECK(run_sunfleck({"import", folder.path("none.ops"), "-o", folder.path("scene.toml")}).exit_code == 2);
  CHECK(run_sunfleck({"import", bad, "-o", folder.path("scene.txt")}).exit_code == 2);
  CHECK(folder.listing() == before);
}
