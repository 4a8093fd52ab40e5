#include <catch2/catch.hpp>

#include "cli/terminal_progress.hpp"

using namespace sunfleck;

TEST_CASE("the time that a phase still takes is told once it is more than a guess", "[cli]") {
  CHECK(time_left(0.5, 0.5).empty());
  CHECK(time_left(30, 0.01).empty());
  CHECK(time_left(2, 0.1) == "18 s left");
  CHECK(time_left(10, 1) == "0 s left");
  CHECK(time_left(60, 0.25) == "3 min left");
  CHECK(time_left(600, 0.02) == "8 h 10 min left");
}
