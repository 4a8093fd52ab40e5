// Natural colour of lit facets: from stored irradiance to light that leaves a side, and from light to display values.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sunfleck/core/vector.hpp>
#include <sunfleck/plant/optics.hpp>

namespace sunfleck {

/// Linear light, primaries and white of sRGB (IEC 61966-2-1). Radiant exitance [W m^-2, or the band's unit] before tone_map(),
/// display values [0, 1] after it.
using Rgb = glm::vec3;
using Rgb8 = std::array<std::uint8_t, 3>;

/// Y of linear sRGB: 0.2126 R + 0.7152 G + 0.0722 B.
float luminance(const Rgb& colour);
/// Linear [0, 1] to 8 bits with the sRGB transfer function; values outside are clamped.
Rgb8 encode_srgb(const Rgb& linear);
/// The inverse, exact for every 8-bit value.
Rgb decode_srgb(const Rgb8& encoded);

/// What a facet is made of, as far as its hue must be guessed.
enum class SurfaceKind : std::uint8_t { leaf, stem, bark, ear, flower, soil, made };
/// Guessed from the words in an organ's type and in the name of its optics, ignoring case: "ground" or "soil"; "stem", "culm", "sheath",
/// ... (green stems); "trunk", "bark", "branch", "metamer", ...; "ear", "spike", "fruit", ...; "flower", "petal", ...; what people make
/// ("wall", "panel", "housing", "door", "pot", "white", ...) is grey; everything else is leaf. The optics decide where both name something.
SurfaceKind surface_of(std::string_view organ_type, std::string_view optics_name);

/// Which bands make red, green and blue.
struct ColourBands {
  std::array<std::size_t, 3> rgb{0, 0, 0};
  bool measured = false;  ///< true: three bands named R, G, B; false: one band that carries a guessed hue
};
/// Bands named R, G, B or red, green, blue (any case) as they are; else PAR (or "VIS", "visible"); else the first band.
ColourBands colour_bands(std::span<const std::string> names);

enum class Side : std::uint8_t { front, back };

/// Light that leaves one side of a facet, B_f = rho_f E_f + tau E_b (fronts and backs swapped for the back), per channel.
/// `irradiance` is [2][b], front then back, with b = number of bands of `optics`. Where the bands are not red, green and blue, the one
/// band's B_f is spread over the channels by the spectrum of a typical surface of its kind (mean of the channels = 1, reflected and
/// transmitted light apart: light through a leaf is yellower). A mesh with one colour a facet takes the mean of both sides.
Rgb facet_colour(const ColourBands& bands, const Optics& optics, SurfaceKind surface, const float* irradiance, Side side);

/// Luminance scale of a picture. Global operator of Reinhard et al. 2002, eq. 4 (doi:10.1145/566654.566575), applied to
/// luminance so that hues stay.
struct Exposure {
  float scale = 1.0f;  ///< luminance -> scaled luminance
  float white = 2.5f;  ///< smallest scaled luminance that maps to 1
};
/// Exposure under which the 90th percentile of the luminances given becomes a bright middle tone; those that are zero are
/// left out. 1 where nothing is lit. The order of the values does not matter.
Exposure exposure_for(std::vector<float> luminances);
/// Scaled luminance L -> L (1 + L / white^2) / (1 + L); channels above 1 fade towards white.
Rgb tone_map(const Rgb& colour, const Exposure& exposure);

}  // namespace sunfleck
