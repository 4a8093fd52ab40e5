#include <sunfleck/light/sky_image.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sunfleck/core/error.hpp>

#include <light/angles.hpp>

namespace sunfleck {

void check_panorama(const Panorama& picture, const std::string& where) {
  if (picture.columns < 4 || picture.columns != 2 * picture.rows || picture.value.size() != std::size_t{picture.columns} * picture.rows)
    throw InputError(where, std::to_string(picture.columns) + " x " + std::to_string(picture.rows) + " pixels",
                     "a picture of all directions (equirectangular), twice as wide as high, 4 columns or more");
  for (std::uint32_t row = 0; row < picture.rows_up(); ++row)
    for (std::uint32_t column = 0; column < picture.columns; ++column)
      if (const float v = picture.at(row, column); !(v >= 0) || std::isinf(v))
        throw InputError(
            where, "radiance " + std::to_string(v) + " in column " + std::to_string(column + 1) + " of row " + std::to_string(row + 1),
            "finite numbers of zero or more");
}

SkyImage::SkyImage(Panorama picture, const std::string& where) : picture_(std::move(picture)) {
  check_panorama(picture_, where);
  picture_ = shrunk(picture_, most_columns);
  const auto end = picture_.value.begin() + std::ptrdiff_t{picture_.columns} * picture_.rows_up();
  const float largest = *std::max_element(picture_.value.begin(), end);
  double sum = 0;
  if (largest > 0)
    for (std::uint32_t row = 0; row < picture_.rows_up(); ++row)
      for (std::uint32_t column = 0; column < picture_.columns; ++column) {
        float& v = picture_.at(row, column);
        v /= largest;  // so that no sum overflows
        sum += static_cast<double>(v) * picture_.level_angle(row, row + 1.0);
      }
  if (!(sum > 0)) throw InputError(where, "a picture that is dark above the horizon", "some light there");
  std::fill(end, picture_.value.end(), 0.0f);  // so that equal skies are equal pictures
  normalisation_ = 1.0 / sum;
}

double SkyImage::relative_radiance(const Vec3& d) const {
  const double zenith = std::acos(std::clamp(d.z, -1.0, 1.0)) / std::numbers::pi;
  const double turns = (std::atan2(d.x, d.y) - picture_.turn_deg * degree) / (2.0 * std::numbers::pi) + 0.5;
  const auto row = std::min(static_cast<std::uint32_t>(zenith * picture_.rows), picture_.rows_up() - 1);
  const auto column = std::min(static_cast<std::uint32_t>((turns - std::floor(turns)) * picture_.columns), picture_.columns - 1);
  return relative_radiance(row, column);
}

bool SkyImage::operator==(const SkyImage& other) const {
  return picture_.columns == other.picture_.columns && picture_.turn_deg == other.picture_.turn_deg &&
         picture_.value == other.picture_.value;
}

}  // namespace sunfleck
