// Photometric files that are broken, cut short or not what they claim.
#include <catch2/catch.hpp>

#include <format_files.hpp>
#include <sunfleck/format/ies.hpp>

using namespace sunfleck;

namespace {

std::string message(const std::string& content) {
  const TextFile file("lamp.ies", content);
  return message_of(file, [&] { read_ies(file.path); });
}

const std::string head = "IESNA:LM-63-2002\n[TEST] none\nTILT=NONE\n";

}  // namespace

TEST_CASE("Photometric files that are no such files", "[hostile][ies]") {
  CHECK(message("") == "lamp.ies: found no line TILT=...; expected an IES LM-63 photometric file");
  CHECK(message("IESNA:LM-63-2002\n1 2 3\n") == "lamp.ies: found no line TILT=...; expected an IES LM-63 photometric file");
  CHECK(message("TILT=\n1 1 1") == "lamp.ies:1: found TILT= without a value; expected TILT=NONE, TILT=INCLUDE or TILT=FILE");
  CHECK(message(std::string("\x89HDF\r\n\x1a\n\0\0\0", 11)) == "lamp.ies: found no line TILT=...; expected an IES LM-63 photometric file");
  CHECK_THROWS_WITH(read_ies("/nowhere/lamp.ies"), Catch::Contains("/nowhere/lamp.ies"));
}

TEST_CASE("Photometric files cut short", "[hostile][ies]") {
  CHECK(message(head) == "lamp.ies:3: found the end of the file; expected the number of lamps");
  CHECK(message(head + "1 1000 1 2\n") == "lamp.ies:4: found the end of the file; expected horizontal angles");
  CHECK(message(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n5\n") ==
        "lamp.ies:8: found the end of the file; expected candela values, 2 of 2");
  CHECK(message(head + "1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n5 5\n7\n") ==
        "lamp.ies:9: found \"7\"; expected nothing after the last intensity");
}

TEST_CASE("Photometric files with numbers that cannot be", "[hostile][ies]") {
  const auto with = [](const std::string& sizes, const std::string& rest) {
    return message(head + "1 1000 1 " + sizes + "\n1 1 100\n" + rest);
  };
  CHECK(with("two 1 1 2 0 0 0", "") == "lamp.ies:4: found \"two\"; expected vertical angles");
  CHECK(with("1 1 1 2 0 0 0", "") == "lamp.ies:4: found 1 vertical angles; expected a whole number from 2 to 100000");
  CHECK(with("2.5 1 1 2 0 0 0", "") == "lamp.ies:4: found 2.5 vertical angles; expected a whole number from 2 to 100000");
  CHECK(with("2 -1 1 2 0 0 0", "") == "lamp.ies:4: found -1 horizontal angles; expected a whole number from 1 to 100000");
  CHECK(with("100000 100000 1 2 0 0 0", "") == "lamp.ies:4: found 100000 by 100000 angles; expected at most 10000000 intensities");
  CHECK(with("2 1 2 2 0 0 0", "") ==
        "lamp.ies:4: found photometry of type B; expected type C (1), which has its poles at nadir and zenith");
  CHECK(with("2 1 1 3 0 0 0", "") ==
        "lamp.ies:4: found 3 the unit of lengths, 1 (feet) or 2 (metres); expected a whole number from 1 to 2");
  CHECK(with("2 1 1 2 nan 0 0", "") == "lamp.ies:4: found \"nan\"; expected the width of the luminous opening, finite");
  CHECK(with("2 1 1 2 0 0 0", "90 0\n0\n1 1\n") == "lamp.ies:5: found vertical angle 0 after 90; expected angles that rise");
  CHECK(with("2 1 1 2 0 0 0", "0 200\n0\n1 1\n") == "lamp.ies:5: found vertical angles from 0 to 200; expected 0 to 180 degrees");
  CHECK(with("2 2 1 2 0 0 0", "0 90\n0 45\n1 1\n1 1\n") ==
        "lamp.ies:5: found horizontal angles from 0 to 45; expected 0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360 degrees");
  CHECK(with("2 1 1 2 0 0 0", "0 90\n0\n1 -1\n") == "lamp.ies:5: found an intensity of -1; expected finite values of zero or more");
  CHECK(with("2 1 1 2 0 0 0", "0 90\n0\n0 0\n") ==
        "lamp.ies:5: found intensities that are zero in all directions; expected a lamp that shines");
  CHECK(with("2 1 1 2 0 0 0", "0 90\n0\n1e300 1e308\n") != "");  // whatever it is, it is said or finite
}

TEST_CASE("Photometric files as the editions of the standard have them", "[hostile][ies]") {
  const auto read = [](const std::string& content) {
    const TextFile file("lamp.ies", content);
    return read_ies(file.path);
  };
  // 1986: no version, free text, numbers broken anywhere, commas; 2002: round opening by negative lengths, in feet
  const auto old = read(
      "A LAMP OF 1986\r\nTILT=INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1 .9 .8\r\n1,1000,1,3,1\r\n1,1 -0.5 0 0\r\n1 1 100\r\n0 45\r\n90\r\n0\r\n9 6 "
      "0\r\n\x1a");
  CHECK(old.vertical_deg == std::vector<double>{0, 45, 90});
  CHECK(old.candela == std::vector<double>{9, 6, 0});
  CHECK(old.round);
  CHECK(old.width_m == Approx(0.5 * 0.3048));
  CHECK(old.length_m == Approx(0.5 * 0.3048));
  const auto recent =
      read("\xef\xbb\xbfIES:LM-63-2019\n[MANUFAC] none\nTILT = NONE\n1 -1 1 2 2 1 2 0.2 1.2 0\n1 1 40\n0 90\n0 90\n4 1\n2 1\n");
  CHECK_FALSE(recent.round);
  CHECK(recent.width_m == 0.2);
  CHECK(recent.length_m == 1.2);
}
