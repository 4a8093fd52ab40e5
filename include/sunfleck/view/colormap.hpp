// Perceptually uniform colour maps for numbers, and distinct colours for names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/view/colour.hpp>

namespace sunfleck {

/// viridis, magma, inferno: van der Walt & Smith 2015 (bids.github.io/colormap); cividis, made for colour-deficient viewers:
/// Nunez, Anderton & Renslow 2018, doi:10.1371/journal.pone.0199239; grey: linear in sRGB code.
/// Stored as our own Chebyshev fits of degree 8 to the published tables: within 2 (viridis), 3 (magma), 4 (inferno) and 7 (cividis) of 255
/// codes. difference: blue over white to red, for values on both sides of zero; lightness and chroma change in equal steps in OKLab
/// (Ottosson 2020, bottosson.github.io/posts/oklab), both ends alike.
enum class ColorMap : std::uint8_t { viridis, magma, inferno, cividis, grey, difference };

/// Throws UsageError with the nearest name for anything else.
ColorMap color_map_from_name(const std::string& name);
const std::vector<std::string>& color_map_names();

/// Display colour (sRGB codes) at t, clamped to [0, 1]; NaN gives mid-grey.
Rgb8 color_at(ColorMap map, double t);

/// Distinct colour of row k of a list of names: fixed colours that colour-deficient viewers tell apart for the first eight (Okabe & Ito
/// 2008, jfly.uni-koeln.de/color), then hues by the golden angle at three lightnesses.
Rgb8 category_color(std::size_t k);

}  // namespace sunfleck
