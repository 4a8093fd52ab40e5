// Comparing a picture with one that was looked at and kept in tests/data.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <sunfleck/view/image.hpp>

#include "places.hpp"

namespace sunfleck::test {

/// RGB, 8 bits; fails the test if the file cannot be read.
Image read_png(const std::string& file);

/// The columns [0, columns) are those of tests/data/NAME, up to what another machine may change: Embree picks the instruction set at run
/// time, so a ray within single precision of an edge may fall on its other side, and the mathematical library rounds differently. The first
/// touches a pixel in about a thousand by 1/9 of its colour or so, the second any by one code: at most 0.5 % of the pixels may differ by
/// more than 2 of 255, and the mean difference must stay below 0.1. A picture of a light, colour, frame or geometry that is wrong differs
/// by far more. To renew it after a change that is meant, run the test with SUNFLECK_GOLDEN=FOLDER, look at the picture written there, and
/// copy it.
inline void check_golden(const Image& image, const std::string& name, int columns) {
  if (const char* folder = std::getenv("SUNFLECK_GOLDEN")) write_png(image, std::string(folder) + "/" + name);
  const Image golden = read_png(std::string(SUNFLECK_SOURCE_DIR) + "/tests/data/" + name);
  REQUIRE(golden.width() == image.width());
  REQUIRE(golden.height() == image.height());
  int off = 0;
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < columns; ++x) {
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const int d = std::abs(int{image.at(x, y)[c]} - int{golden.at(x, y)[c]});
        most = std::max(most, d), sum += d / 3.0;
      }
      off += most > 2;
    }
  const double pixels = static_cast<double>(columns) * image.height();
  INFO(name << ": " << off << " pixels differ by more than 2 codes, " << sum / pixels << " codes on average");
  CHECK(off <= 0.005 * pixels);
  CHECK(sum / pixels < 0.1);
}

}  // namespace sunfleck::test
