#include <sunfleck/format/read_plant.hpp>

#include <catch2/catch.hpp>

#include <format_files.hpp>

using namespace sunfleck;

namespace {

std::string message(const char* text) {
  const TextFile file("bad.can", text);
  return message_of(file, [&] { read_plant(file.path); });
}

}  // namespace

TEST_CASE("Broken CAN files are named with their line", "[format][can]") {
  CHECK(message("\nq 1 2\n") == "bad.can:2: found \"q\"; expected a polygon \"p 1 LABEL 3 x y z ...\" or a comment \"# ...\"");
  CHECK(message("p 0 100000000001 3\n") == "bad.can:1: found number of labels \"0\"; expected a whole number of at least 1");
  CHECK(message("p 1 leaf 3\n") == "bad.can:1: found label \"leaf\"; expected 12 digits: species, plant (5), leaf (3), element (3)");
  CHECK(message("p 1\n") == "bad.can:1: found label \"\"; expected 12 digits: species, plant (5), leaf (3), element (3)");
  CHECK(message("p 1 100000000001 2 0 0 0 1 1 1\n") == "bad.can:1: found number of corners \"2\"; expected a whole number of at least 3");
  CHECK(message("p 1 100000000001 3 0 0 0 1 1 1 2 2\n") == "bad.can:1: found a corner with 2 coordinates; expected three numbers");
  CHECK(message("p 1 100000000001 3 0 0 0 1 NaN 1 2 2 2\n") == "bad.can:1: found a corner coordinate \"NaN\"; expected a finite number");
  CHECK(message("p 1 100000000001 3 0 0 0 1 1 1 2 2 2 3\n") == "bad.can:1: found \"3\" after 3 corners; expected the end of the line");
  CHECK(message("p 1 100000000001 999999999999 0 0 0\n") == "bad.can:1: found a corner with 0 coordinates; expected three numbers");
  CHECK(message("# nothing\n") == "bad.can: found no face; expected at least one triangle or polygon");
}
