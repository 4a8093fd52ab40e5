#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const char* text) {
  const TextFile file("bad.obj", text);
  return message_of(file, [&] { read_plant(file.path); });
}

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("Broken OBJ files are named with their line", "[format][obj]") {
  CHECK(message((three + "f 1 2 9\n").c_str()) ==
        "bad.obj:4: found vertex index 9; expected 1 to 3 (vertices in the file), or counted back from -1");
  CHECK(message((three + "f 0 1 2\n").c_str()) ==
        "bad.obj:4: found vertex index 0; expected 1 to 3 (vertices in the file), or counted back from -1");
  CHECK(message((three + "f -4 1 2\n").c_str()) ==
        "bad.obj:4: found vertex index -4; expected 1 to 3 (vertices in the file), or counted back from -1");
  CHECK(message((three + "f 1 2\n").c_str()) == "bad.obj:4: found a face with 2 corners; expected at least three");
  CHECK(message((three + "f 1 2 b/1\n").c_str()) == "bad.obj:4: found face corner \"b/1\"; expected a vertex index such as 7 or 7/1/2");
  CHECK(message("v 0 nan 0\n") == "bad.obj:1: found a vertex coordinate \"nan\"; expected a finite number");
  CHECK(message("v 0 0 -inf\n") == "bad.obj:1: found a vertex coordinate \"-inf\"; expected a finite number");
  CHECK(message("\nv 0 1e999 0\n") == "bad.obj:2: found a vertex coordinate \"1e999\"; expected a finite number");
  CHECK(message("v 0 1,5 0\n") == "bad.obj:1: found a vertex coordinate \"1,5\"; expected a finite number");
  CHECK(message("v 0 1\n") == "bad.obj:1: found a vertex with 2 coordinates; expected three numbers");
  CHECK(message("") == "bad.obj: found no face; expected at least one triangle or polygon");
  CHECK(message(three.c_str()) == "bad.obj: found no face; expected at least one triangle or polygon");
}

TEST_CASE("A material library elsewhere is not opened, and worth a note", "[format][obj]") {
  const auto notes = [](const std::string& head) {
    const TextFile file("p.obj", head + three + "f 1 2 3\n");
    return read_plant(file.path).notes;
  };
  CHECK(notes("mtllib p.mtl\nmtllib sub folder/p.mtl\n").empty());
  for (const char* line : {"mtllib ../../secret.mtl\n", "mtllib /etc/passwd\n", "mtllib a.mtl ../b.mtl\n"}) {
    INFO(line);
    REQUIRE(notes(line).size() == 1);
    CHECK(notes(line)[0].find("p.obj: mtllib names a file outside the folder of the OBJ: material libraries are not needed") !=
          std::string::npos);
  }
  CHECK(notes("mtllib /a.mtl\nmtllib /b.mtl\n").size() == 1);
}

TEST_CASE("A backslash at the end of a comment or a name swallows nothing; numbers go on", "[format][obj]") {
  for (const char* line :
       {"# from C:\\plants\\\n", "mtllib C:\\plants\\\n", "g leaf\\\n", "o leaf\\\n", "usemtl a\\\n", "v 9 9 9 # C:\\\n", "\\\n"}) {
    const TextFile file("p.obj", line + three + "f -3 -2 \\\n -1\nf -3 -2 -1 # C:\\\nf -1 -2 -3\n");
    INFO(line);
    const Plant plant = read_plant(file.path);
    CHECK(plant.facet_count() == 3);
    CHECK(plant.area() == Approx(1.5));
  }
  const TextFile named("p.obj", "g leaf\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(read_plant(named.path).structures.at(1).name == "leaf\\");
}

TEST_CASE("A missing file, a folder and an unknown suffix are refused", "[format]") {
  const TextFile file("plant.txt", "hello");
  CHECK(message_of(file, [&] { read_plant(file.folder() + "/absent.obj"); }) ==
        "absent.obj: found no such file; expected an existing file");
  CHECK(message_of(file, [&] { read_plant(file.path, 0.0); }) == "plant.txt: found unit of 0 m; expected a length above zero");
  std::filesystem::create_directories(file.folder() + "/folder.obj");
  CHECK(message_of(file, [&] { read_plant(file.folder() + "/folder.obj"); }) == "folder.obj: found a folder; expected a file");
}

TEST_CASE("An unknown suffix is refused with the known ones", "[format]") {
  const TextFile file("plant.txt", "hello"), none("plant", "hello");
  CHECK(message_of(file, [&] { read_plant(file.path); }) ==
        "plant.txt: found suffix \".txt\"; expected .opf, .obj, .ply, .can, .h5 or .toml (a species)");
  CHECK(message_of(none, [&] { read_plant(none.path); }) ==
        "plant: found no suffix; expected .opf, .obj, .ply, .can, .h5 or .toml (a species)");
}
