// Legends: a bar with ticks for numbers, a list for names.
#pragma once

#include <string>
#include <vector>

#include <sunfleck/view/colormap.hpp>
#include <sunfleck/view/text.hpp>

namespace sunfleck {

/// From values to [0, 1], linear or logarithmic.
struct ValueScale {
  double low = 0, high = 1;
  bool logarithmic = false;
  /// Position of a value, not clamped: below 0 or above 1 outside the range. Logarithmic: values at or below zero give -infinity.
  double position(double value) const;
};

/// Range over the values: from their 1st to their 99th percentile (so that one outlier does not darken the rest), widened to
/// zero where the low end is less than a quarter of the high one; logarithmic: positive values only, at most four decades. A range of zero
/// width is opened around its value. Values that are not finite are left out; {0, 1} where nothing is left.
ValueScale scale_for(std::vector<double> values, bool logarithmic);

struct Tick {
  double value;
  std::string label;
};
/// Round values inside the range: steps of 1, 2 or 5 times a power of ten, about `wanted` of them (Heckbert 1990, "Nice numbers for graph
/// labels", Graphics Gems); logarithmic over more than a decade: 1, 2, 5 or powers of ten.
std::vector<Tick> nice_ticks(const ValueScale& scale, int wanted = 6);

/// Where a legend is drawn, in pixels; `size` is the height of a text line.
struct LegendPlace {
  int left = 0, top = 0, width = 0, height = 0;
  double size = 18;
};
/// Title lines, colour bar and labelled ticks; `below` and `above` tell that values lie outside, drawn as tips on the bar.
void draw_bar(Image& image, const Font& font, const LegendPlace& place, const std::vector<std::string>& title, ColorMap map,
              const ValueScale& scale, bool below, bool above);
/// Title lines and one square per name; what does not fit becomes "… and N more".
void draw_list(Image& image, const Font& font, const LegendPlace& place, const std::vector<std::string>& title,
               const std::vector<std::string>& names, const std::vector<Rgb8>& colours);

}  // namespace sunfleck
