// Numbers behind the pixels of a picture, for EXR files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sunfleck {

inline constexpr std::uint32_t no_row = 0xffffffffu;

/// Rows from the top; w x h pixels. Colour is the mean over a pixel's samples, everything else what the sample nearest to its middle meets.
struct PictureLayers {
  int width = 0, height = 0;
  std::vector<float> red, green, blue;  ///< natural colour: light that leaves what is seen, before tone mapping, without sky and decoration
                                        ///< [W m^-2 or the band's unit]; maps: the colour map, linear sRGB. Multiplied by alpha
  std::vector<float> alpha;             ///< covered share of the pixel, 0 to 1
  std::vector<float> depth;             ///< along the line of sight from the camera's plane [m]; infinite where nothing is met
  std::vector<std::uint32_t> organ;     ///< row of /organs; no_row where nothing is met
  std::vector<std::uint32_t> facet;     ///< row of /facets; no_row where nothing is met, or the row does not fit
  std::vector<float> value;             ///< the quantity of a map, NaN where there is none; empty for natural colour

  void resize(int w, int h, bool with_value);
};

/// OpenEXR, ZIP compressed, channels R G B A (half), Z (float), organ.id, facet.id (uint) and, where there, value (float). Complete or not
/// at all. Throws UsageError unless the name ends in .exr, OutputError where it cannot be written.
void write_exr(const PictureLayers& layers, const std::string& file);

}  // namespace sunfleck
