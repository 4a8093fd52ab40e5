// Pictures of the sky as files hold them.
#pragma once

#include <string>

#include <sunfleck/light/panorama.hpp>

namespace sunfleck {

/// How numbers of a picture stand for light; HDR and EXR are linear.
enum class PictureCode { by_depth, linear, srgb };  ///< by_depth: 8 bits sRGB, 16 bits linear

/// A picture has at most so many columns.
inline constexpr int most_picture_columns = 8192;

/// Luminances (.2126 R + .7152 G + .0722 B, Rec. 709) of a picture in Radiance HDR, OpenEXR or PNG, known by its first bytes. Throws
/// InputError naming the file if it is none, is cut off or broken, or is not twice as wide as high.
Panorama read_panorama(const std::string& file, PictureCode code);

/// Of an EXR file's bytes; throws InputError if this build is without EXR.
Panorama read_exr(const std::string& bytes, const std::string& file);

/// An InputError unless a picture of so many pixels is one of all directions.
void check_picture_size(long long columns, long long rows, const std::string& file);

inline float luminance(float r, float g, float b) {
  return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace sunfleck
