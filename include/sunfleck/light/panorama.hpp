// Pictures of all directions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <sunfleck/core/vector.hpp>

namespace sunfleck {

/// Radiances on a grid of equal steps of azimuth and zenith angle (equirectangular): row 0 lies about the zenith, the last about the nadir;
/// the middle of the columns looks to azimuth `turn_deg`, from north over east, and columns go on clockwise, as one sees them who turns to
/// the right. Only the ratios of values count.
struct Panorama {
  std::uint32_t columns = 0, rows = 0;
  std::vector<float> value;  ///< [rows][columns]
  double turn_deg = 0;

  float& at(std::uint32_t row, std::uint32_t column) { return value[std::size_t{row} * columns + column]; }
  float at(std::uint32_t row, std::uint32_t column) const { return value[std::size_t{row} * columns + column]; }
  /// Rows that reach above the horizon; the last of an odd number by half.
  std::uint32_t rows_up() const { return (rows + 1) / 2; }
  /// Unit vector to a place of the grid: row and column with fractions, (.5, .5) the middle of the first pixel.
  Vec3 direction(double row, double column) const;
  /// Solid angle between two rows, with fractions, that lies above the horizon, over one column [sr]; `level`: weighted by the cosine of
  /// the zenith angle.
  double solid_angle(double row, double next_row) const;
  double level_angle(double row, double next_row) const;
};

/// The same light on a coarser grid of at most so many columns: every pixel's horizontal irradiance goes to the pixels it overlaps.
Panorama shrunk(const Panorama& fine, std::uint32_t most_columns);

/// The sun as a picture has it.
struct PicturedSun {
  Vec3 direction{0, 0, 1};  ///< to the middle of its light
  double horizontal_share =
      0;  ///< of the irradiance of a horizontal plane under the picture, what the sun brings above the sky behind it [-]
};

/// Takes the sun out of a picture: the brightest pixel above the horizon and those joined to it that are more than 10 times as bright as
/// the sky 2.5 to 10 degrees from it (its median), if the brightest is more than 50 times so and all together are no wider than a disc of 8
/// degrees; the median takes their place. Nothing, and the picture as it was, where no sun is seen.
std::optional<PicturedSun> take_sun(Panorama& picture);

}  // namespace sunfleck
