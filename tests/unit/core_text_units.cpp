#include <catch2/catch.hpp>

#include <sunfleck/core/text_units.hpp>

using namespace sunfleck;

TEST_CASE("bytes, counts and plurals read well", "[cli]") {
  CHECK(bytes_text(0) == "0 B");
  CHECK(bytes_text(1023) == "1023 B");
  CHECK(bytes_text(1536) == "1.5 KiB");
  CHECK(bytes_text(3.0 * 1024 * 1024 * 1024) == "3.0 GiB");
  CHECK(count_text(999) == "999");
  CHECK(count_text(12345) == "12.3 k");
  CHECK(count_text(4.56e6) == "4.56 M");
  CHECK(counted(1, "copy", "copies") == "1 copy");
  CHECK(counted(0, "copy", "copies") == "0 copies");
}
