// Every mesh format read again by programs that are not ours: tests/readers/check_export.py compares their numbers with the result's.
#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <sunfleck/core/progress.hpp>
#include <sunfleck/plant/build.hpp>
#include <sunfleck/scene/build.hpp>
#include <sunfleck/view/export.hpp>

#include "places.hpp"
#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

namespace {

const std::string python = "/usr/bin/python3";
const bool all_readers = std::getenv("SUNFLECK_READERS") != nullptr;  ///< tools/test has installed them: none may be skipped
const std::string script = std::string(SUNFLECK_SOURCE_DIR) + "/tests/readers/check_export.py";

void store(const Scene& scene, const std::string& file) {
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  ResultWriter writer(file, scene, placed, OutputChoice{}, "0.1.0", "flat");
  Values(facets, scene.states.size()).send(writer, 1000);
  SolveReport report = small_report();
  report.balance.resize(scene.states.size());
  writer.finish(report);
}

void check(const Folder& folder, const std::vector<std::string>& names) {
  std::string command = python + " " + script + " " + (folder / "r.h5");
  for (const auto& name : names) command += " " + (folder / name);
  INFO(command);
  CHECK(std::system((command + " > " + (folder / "log") + " 2>&1").c_str()) == 0);
  std::ifstream log(folder / "log");
  for (std::string line; std::getline(log, line);) {
    if (line.rfind("skipped", 0) == 0) WARN(line);
    INFO(line);
    if (all_readers) CHECK(line.rfind("skipped", 0) != 0);
    CHECK(line.rfind("DIFFERS", 0) != 0);
  }
}

}  // namespace

TEST_CASE("Lit meshes are read again by independent readers, with the result's numbers", "[view][export][readers]") {
  if (!all_readers && std::system((python + " -c 'import h5py' 2>/dev/null").c_str()) != 0) {
    WARN("skipped: " << python << " with h5py is not there");
    return;
  }
  Progress progress;
  const Folder folder;
  SECTION("copies, mirrors, groups and ground, two states") {
    store(small_scene(700), folder / "r.h5");
    const Result result(folder / "r.h5");
    export_ply(result, folder / "m.ply", {}, progress);
    export_obj(result, folder / "m.obj", {}, progress);
    export_glb(result, folder / "m.glb", {}, progress);
    export_vtkhdf(result, folder / "m.vtkhdf", {}, progress);
    export_xdmf(result, folder / "m.xdmf", {}, progress);
    check(folder, {"m.ply", "m.obj", "m.glb", "m.vtkhdf", "m.xdmf"});
  }
  SECTION("tables, and a plant written back") {
    const Scene scene = small_scene(300);
    store(scene, folder / "r.h5");
    const Result result(folder / "r.h5");
    export_csv(result, folder / "organs.csv", progress);
    export_groups(result, folder / "groups.csv", "placement,type", progress);
    const std::string copy = result.strings("names/placement").at(1);  // the mirrored one
    REQUIRE(copy == "shrub[1]");
    REQUIRE(std::system((std::string(SUNFLECK_PROGRAM) + " export " + (folder / "r.h5") + " -o " + (folder / "shrub_1.opf") +
                         " --copy 'shrub[1]' 2>/dev/null")
                            .c_str()) == 0);
    check(folder, {"organs.csv", "groups.csv", "shrub_1.opf"});
  }
  SECTION("copies that share colours are instances") {
    store(small_scene(300), folder / "r.h5");
    const Result result(folder / "r.h5");
    MeshChoice choice;
    choice.quantity = "type";
    export_glb(result, folder / "m.glb", choice, progress);
    std::ifstream in(folder / "m.glb", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    CHECK(bytes.find("\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"]") != std::string::npos);
    CHECK(bytes.find("\"name\":\"shrub x 3\"") != std::string::npos);
    check(folder, {"m.glb"});
  }
  SECTION("far from the origin") {
    Scene scene = small_scene();
    for (auto& plant : scene.plants)
      for (auto& place : plant.placements) place.map.translation += Vec3{654321.0, 5234567.0, 120.0};
    scene.groups[0].placements[0].map.translation += Vec3{654321.0, 5234567.0, 120.0};
    scene.ground->centre = {654321.0, 5234567.0};
    store(scene, folder / "r.h5");
    const Result result(folder / "r.h5");
    export_glb(result, folder / "m.glb", {}, progress);
    export_obj(result, folder / "m.obj", {}, progress);
    check(folder, {"m.glb", "m.obj"});
  }
  SECTION("a result that holds its vertices in the world: XDMF without a mesh of its own") {
    Scene scene = small_scene();
    scene.groups.clear();
    scene.plants.clear();
    const Mesh leaf{{{0, 0, 1}, {0.5, 0, 1}, {0.5, 0.5, 1.2}, {0, 0.5, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    scene.plants.push_back(plant_entry("leaf", make_plant(leaf), 0, {Placement{}}));
    store(scene, folder / "r.h5");
    const Result result(folder / "r.h5");
    export_xdmf(result, folder / "m.xdmf", {}, progress);
    std::ifstream in(folder / "m.xdmf");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(text.find("r.h5:/geometry/vertices") != std::string::npos);
    CHECK(text.find("m.xdmf.h5:/points") == std::string::npos);
    check(folder, {"m.xdmf"});
  }
}
