#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include <sunfleck/core/error.hpp>

#include "cli/output_path.hpp"

using namespace sunfleck;

TEST_CASE("an output path is checked before any work", "[cli]") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "sunfleck_output_path";
  fs::create_directories(folder / "directory.h5");
  const std::string good = (folder / "result.h5").string();
  const std::string scene = (folder / "scene.h5").string();
  std::ofstream(scene) << "x";

  CHECK_NOTHROW(check_output_path(good, {".h5"}));
  CHECK_NOTHROW(check_output_path((folder / "RESULT.H5").string(), {".h5"}));
  CHECK_FALSE(fs::exists(good));
  CHECK_THROWS_WITH(check_output_path("a.txt", {".ply", ".csv"}), "a.txt: found suffix '.txt'; expected .ply, .csv");
  CHECK_THROWS_WITH(check_output_path("a", {".h5"}), "a: found suffix ''; expected .h5");
  const std::string missing = (folder / "none" / "r.h5").string();
  CHECK_THROWS_WITH(check_output_path(missing, {".h5"}),
                    missing + ": found no folder '" + (folder / "none").string() + "'; expected one that exists");
  const std::string directory = (folder / "directory.h5").string();
  CHECK_THROWS_WITH(check_output_path(directory, {".h5"}), directory + ": found a directory; expected a file to write");
  CHECK_THROWS_WITH(check_output_path(scene, {".h5"}, {scene}), scene + ": found the input file; expected another name to write to");
  fs::remove_all(folder);
}
