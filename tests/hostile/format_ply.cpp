#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const std::string& text) {
  const TextFile file("bad.ply", text);
  return message_of(file, [&] { read_plant(file.path); });
}

std::string header(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string points = "0 0 0\n1 0 0\n0 1 0\n";

}  // namespace

TEST_CASE("Broken PLY headers are named with their line", "[format][ply]") {
  CHECK(message("") == "bad.ply:1: found \"\"; expected \"ply\"");
  CHECK(message("solid\n") == "bad.ply:1: found \"solid\"; expected \"ply\"");
  CHECK(message("ply\nformat ascii 1.0\n") == "bad.ply:2: found the end of the file in the header; expected end_header");
  CHECK(message("ply\nformat utf8 1.0\n") == "bad.ply:2: found format \"utf8\"; expected ascii, binary_little_endian or binary_big_endian");
  CHECK(message("ply\nend_header\n") == "bad.ply:2: found no format; expected ascii, binary_little_endian or binary_big_endian");
  CHECK(message("ply\nproperty float x\n") == "bad.ply:2: found a property before any element; expected an element line first");
  CHECK(message("ply\nelement vertex -3\n") == "bad.ply:2: found element \"vertex\" \"-3\"; expected a name and a count");
  CHECK(message("ply\nelement vertex 1\nproperty half x\n") ==
        "bad.ply:3: found property type \"half\"; expected char, uchar, short, ushort, int, uint, float or double");
  CHECK(message("ply\nformat ascii 1.0\nelement face 0\nend_header\n") ==
        "bad.ply: found no element vertex; expected vertices with x, y and z");
  CHECK(message("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nelement face 0\nend_header\n0\n") ==
        "bad.ply: found no vertex property y; expected x, y and z");
}

TEST_CASE("Broken PLY bodies are named with their line or byte", "[format][ply]") {
  CHECK(message(header("ascii", "3", "1") + points + "3 0 1 3\n") == "bad.ply:13: found vertex index 3 in face 0; expected 0 to 2");
  CHECK(message(header("ascii", "3", "1") + points + "3 0 1 -1\n") == "bad.ply:13: found vertex index -1 in face 0; expected 0 to 2");
  CHECK(message(header("ascii", "3", "1") + points + "2 0 1\n") == "bad.ply:13: found face 0 with 2 corners; expected at least three");
  CHECK(message(header("ascii", "3", "1") + points + "3 0 1\n") ==
        "bad.ply:13: found the end of the line before \"vertex_indices\"; expected a number");
  CHECK(message(header("ascii", "3", "1") + points + "3 0 1 2 3\n") ==
        "bad.ply:13: found \"3\" after the last value; expected the end of the line");
  CHECK(message(header("ascii", "3", "1") + "0 0 nan\n0 0 0\n1 1 1\n3 0 1 2\n") ==
        "bad.ply:10: found z = nan in vertex 0; expected a finite number");
  CHECK(message(header("ascii", "3", "1") + "0 0 0\n0 x 0\n1 1 1\n3 0 1 2\n") == "bad.ply:11: found \"x\" for \"y\"; expected a number");
  CHECK(message(header("ascii", "3", "2") + points + "3 0 1 2\n") ==
        "bad.ply:13: found the end of the file in element \"face\"; expected 2 of them");
  CHECK(message(header("ascii", "3", "0") + points) == "bad.ply: found no face; expected at least one triangle or polygon");
  CHECK(
      message(header("binary_little_endian", "4000000000", "1") + "abc") ==
      "bad.ply: byte 178: found 4000000000 times element \"vertex\" in the header; expected no more than fit into the 3 bytes that follow");
  CHECK(message(header("binary_little_endian", "1", "1") + std::string(12, '\0') + "\x03" + std::string(4, '\0')) ==
        "bad.ply: byte 181: found 3 values in list \"vertex_indices\"; expected 0 to 1");
}
