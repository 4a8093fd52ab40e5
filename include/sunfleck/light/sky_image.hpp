// A sky that is known as a picture.
#pragma once

#include <string>

#include <sunfleck/light/panorama.hpp>

namespace sunfleck {

/// Every pixel of the upper half of a picture shines evenly. Finer pictures than `most_columns` are shrunk, which keeps their light.
class SkyImage {
 public:
  static constexpr std::uint32_t most_columns = 2048;  ///< .18 degrees

  /// Throws InputError(where) for a picture that is not twice as wide as high, has fewer than 4 columns, a value above the horizon that is
  /// negative or not finite, or gives a horizontal plane no light.
  SkyImage(Panorama picture, const std::string& where);

  const Panorama& picture() const { return picture_; }
  /// The radiance towards a unit vector above the horizon, of a sky that lights a horizontal plane with 1 [sr^-1].
  double relative_radiance(const Vec3& d) const;
  double relative_radiance(std::uint32_t row, std::uint32_t column) const { return normalisation_ * picture_.at(row, column); }
  bool operator==(const SkyImage& other) const;

 private:
  Panorama picture_;
  double normalisation_ = 1.0;
};

/// Throws InputError(where) as the constructor of SkyImage does, for all but a dark picture.
void check_panorama(const Panorama& picture, const std::string& where);

}  // namespace sunfleck
