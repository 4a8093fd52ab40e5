#include <sunfleck/view/colour.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include "view/lower_case.hpp"

namespace sunfleck {

namespace {

/// Relative spectra of ordinary surfaces under daylight, mean of the channels 1. Leaves: green peak of chlorophyll, light that
/// went through has lost more blue (shapes after Jacquemoud & Baret 1990, doi:10.1016/0034-4257(90)90100-Z).
struct Tint {
  Rgb reflected, transmitted;
};

Tint tint_of(SurfaceKind surface) {
  switch (surface) {
    case SurfaceKind::leaf:
      return {{0.84f, 1.86f, 0.30f}, {1.04f, 1.86f, 0.10f}};
    case SurfaceKind::stem:
      return {{1.02f, 1.56f, 0.42f}, {1.08f, 1.72f, 0.20f}};
    case SurfaceKind::bark:
      return {{1.26f, 0.99f, 0.75f}, {1.26f, 0.99f, 0.75f}};
    case SurfaceKind::ear:
      return {{1.35f, 1.15f, 0.50f}, {1.40f, 1.25f, 0.35f}};
    case SurfaceKind::flower:
      return {{1.30f, 0.75f, 0.95f}, {1.35f, 0.70f, 0.95f}};
    case SurfaceKind::made:
      return {{1.02f, 1.00f, 0.98f}, {1.02f, 1.00f, 0.98f}};
    case SurfaceKind::soil:
      return {{1.31f, 0.99f, 0.70f}, {1.31f, 0.99f, 0.70f}};
  }
  return {Rgb{1.0f}, Rgb{1.0f}};
}

bool has_any(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

/// A word of its own, so that "ear" is not found in "linear".
bool has_word(const std::string& text, std::string_view word) {
  const auto letter = [&](std::size_t i) { return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0; };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !letter(at - 1)) && !letter(at + word.size())) return true;
  return false;
}

bool guess(const std::string& text, SurfaceKind& out) {
  if (has_any(text, {"ground", "soil", "terrain"})) return out = SurfaceKind::soil, true;
  if (has_any(text, {"leaf", "leaves", "blade", "lamina", "needle", "frond", "foliage"})) return out = SurfaceKind::leaf, true;
  if (has_any(text, {"flower", "petal", "corolla", "blossom"})) return out = SurfaceKind::flower, true;
  if (has_any(text, {"spike", "fruit", "grain", "panicle", "tassel", "seed"}) || has_word(text, "ear") || has_word(text, "cob"))
    return out = SurfaceKind::ear, true;
  if (has_any(text, {"stem", "culm", "sheath", "petiole", "rachis", "peduncle", "stalk"})) return out = SurfaceKind::stem, true;
  if (has_any(text, {"trunk", "bark", "branch", "wood", "metamer", "internode", "twig", "bole", "axis"}))
    return out = SurfaceKind::bark, true;
  if (has_any(text, {"wall", "ceiling", "panel", "housing", "concrete", "metal", "glass", "plastic"}) || has_word(text, "door") ||
      has_word(text, "white") || has_word(text, "pot") || has_word(text, "pots"))
    return out = SurfaceKind::made, true;
  return false;
}

}  // namespace

float luminance(const Rgb& colour) {
  return 0.2126f * colour.r + 0.7152f * colour.g + 0.0722f * colour.b;
}

Rgb8 encode_srgb(const Rgb& linear) {
  const auto channel = [](float x) {
    x = std::clamp(x, 0.0f, 1.0f);
    const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(255.0f * y));
  };
  return {channel(linear.r), channel(linear.g), channel(linear.b)};
}

Rgb decode_srgb(const Rgb8& encoded) {
  const auto channel = [](std::uint8_t v) {
    const float y = static_cast<float>(v) / 255.0f;
    return y <= 0.04045f ? y / 12.92f : std::pow((y + 0.055f) / 1.055f, 2.4f);
  };
  return {channel(encoded[0]), channel(encoded[1]), channel(encoded[2])};
}

SurfaceKind surface_of(std::string_view organ_type, std::string_view optics_name) {
  SurfaceKind out = SurfaceKind::leaf;
  if (!guess(lower_case(optics_name), out)) guess(lower_case(organ_type), out);
  return out;
}

ColourBands colour_bands(std::span<const std::string> names) {
  const auto find = [&](std::initializer_list<std::string_view> any) {
    return static_cast<std::size_t>(
        std::find_if(names.begin(), names.end(),
                     [&](const std::string& n) { return std::find(any.begin(), any.end(), lower_case(n)) != any.end(); }) -
        names.begin());
  };
  const std::size_t red = find({"r", "red"}), green = find({"g", "green"}), blue = find({"b", "blue"});
  if (red < names.size() && green < names.size() && blue < names.size()) return {{red, green, blue}, true};
  const std::size_t visible = find({"par", "vis", "visible", "ppfd"}), one = visible < names.size() ? visible : 0;
  return {{one, one, one}, false};
}

Rgb facet_colour(const ColourBands& bands, const Optics& optics, SurfaceKind surface, const float* irradiance, Side side) {
  const std::size_t b = optics.transmittance.size();
  const auto& reflectance = side == Side::front ? optics.reflectance_front : optics.reflectance_back;
  const float* own = irradiance + (side == Side::front ? 0 : b);
  const float* other = irradiance + (side == Side::front ? b : 0);
  if (bands.measured) {
    Rgb out;
    for (int c = 0; c < 3; ++c) {
      const std::size_t k = bands.rgb[static_cast<std::size_t>(c)];
      out[c] = reflectance[k] * own[k] + optics.transmittance[k] * other[k];
    }
    return out;
  }
  const std::size_t k = bands.rgb[0];
  const Tint tint = tint_of(surface);
  return reflectance[k] * own[k] * tint.reflected + optics.transmittance[k] * other[k] * tint.transmitted;
}

Exposure exposure_for(std::vector<float> luminances) {
  luminances.erase(std::remove_if(luminances.begin(), luminances.end(), [](float l) { return !(l > 0.0f); }), luminances.end());
  if (luminances.empty()) return {};
  const auto at = luminances.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(luminances.size() - 1) * 0.9);
  std::nth_element(luminances.begin(), at, luminances.end());
  return {.scale = 0.5f / *at, .white = 2.5f};
}

Rgb tone_map(const Rgb& colour, const Exposure& exposure) {
  const float scaled = luminance(colour) * exposure.scale;
  if (!(scaled > 0.0f)) return Rgb{0.0f};
  const float mapped = std::min(1.0f, scaled * (1.0f + scaled / (exposure.white * exposure.white)) / (1.0f + scaled));
  Rgb out = colour * (exposure.scale * mapped / scaled);
  // A saturated hue can leave the display's range at a luminance that is still in it: move towards grey of the same luminance.
  const float top = std::max({out.r, out.g, out.b});
  if (top > 1.0f && top > mapped) {
    const float keep = (1.0f - mapped) / (top - mapped);
    out = Rgb{mapped} + keep * (out - Rgb{mapped});
  }
  return out;
}

}  // namespace sunfleck
