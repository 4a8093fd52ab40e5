#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/input_file.hpp>
#include <sunfleck/format/scene_inputs.hpp>

#include "scratch_folder.hpp"

using namespace sunfleck;

namespace fs = std::filesystem;

TEST_CASE("only files are read, and nothing waits", "[core][input]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/f", pipe = folder.path + "/p";
  std::ofstream(file) << "text";
  CHECK(read_input_file(file) == "text");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_input_file(pipe), pipe + ": found a pipe; expected a file");
  CHECK_THROWS_WITH(read_input_file("/dev/zero"), "/dev/zero: found a device or socket; expected a file");
  CHECK_THROWS_WITH(read_input_file(folder.path), folder.path + ": found a folder; expected a file");
  CHECK_THROWS_WITH(read_input_file(folder.path + "/none"), folder.path + "/none: found no such file; expected an existing file");
  CHECK(read_input_file("/proc/self/comm").size() > 1);  // a file that says it has no size
}

TEST_CASE("what was read is known again by every name, and only while someone wants to know", "[core][input]") {
  const ScratchFolder folder;
  const std::string file = folder.path + "/f", link = folder.path + "/l", hard = folder.path + "/h", other = folder.path + "/o";
  std::ofstream(file) << "text";
  std::ofstream(other) << "text";
  fs::create_symlink("f", link);
  fs::create_hard_link(file, hard);
  read_input_file(file);
  CHECK_FALSE(InputRecord::input_behind(file));
  const InputRecord record;
  CHECK_FALSE(InputRecord::input_behind(file));
  read_input_file(file);
  for (const auto& name : {file, link, hard, folder.path + "/./f"}) CHECK(InputRecord::input_behind(name) == file);
  CHECK_FALSE(InputRecord::input_behind(other));
  CHECK_FALSE(InputRecord::input_behind(folder.path + "/none"));
  {
    const InputRecord aside;
    read_input_file(other);
  }
  CHECK_FALSE(InputRecord::input_behind(other));
}

TEST_CASE("the text of a scene names its files", "[core][input][format]") {
  const ScratchFolder folder;
  for (const char* name : {"/a.obj", "/b.csv", "/c.mtl", "/scene.toml", "/d.obj"}) std::ofstream(folder.path + name) << "mtllib c.mtl\n";
  const InputRecord record;
  note_scene_inputs("[[plant]]\nfile = \"a.obj\"\nplace = { file = \"b.csv\" }\nother = [[\"none.obj\"], \"text\", 3]\n",
                    folder.path + "/scene.toml");
  for (const char* name : {"/a.obj", "/b.csv", "/c.mtl", "/scene.toml"}) CHECK(InputRecord::input_behind(folder.path + name));
  CHECK_FALSE(InputRecord::input_behind(folder.path + "/d.obj"));
  CHECK_NOTHROW(note_scene_inputs("= no TOML", folder.path + "/d.obj"));
}
