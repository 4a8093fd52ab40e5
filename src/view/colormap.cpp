#include <sunfleck/view/colormap.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t terms = 9;
/// Chebyshev coefficients of red, green and blue over t in [0, 1].
using Fit = std::array<std::array<double, terms>, 3>;

constexpr Fit viridis{{{0.4087, 0.2983, 0.2550, 0.0803, -0.0332, -0.0195, -0.0020, 0.0094, 0.0016},
                       {0.5187, 0.4547, -0.0574, -0.0049, -0.0085, 0.0008, 0.0021, 0.0013, 0.0007},
                       {0.3759, -0.1468, -0.1707, 0.0212, 0.0146, 0.0292, 0.0140, 0.0068, 0.0029}}};
constexpr Fit magma{{{0.5911, 0.5510, -0.1184, -0.0625, 0.0174, 0.0072, 0.0073, -0.0061, -0.0033},
                     {0.3699, 0.4805, 0.1439, 0.0198, -0.0196, -0.0054, -0.0050, 0.0095, 0.0067},
                     {0.4143, 0.2454, -0.0434, 0.1535, 0.0064, -0.0301, 0.0002, -0.0109, 0.0042}}};
constexpr Fit inferno{{{0.5905, 0.5318, -0.1329, -0.0506, 0.0201, 0.0078, 0.0138, 0.0015, 0.0034},
                       {0.3771, 0.4999, 0.1460, 0.0063, -0.0189, -0.0060, -0.0075, 0.0068, 0.0028},
                       {0.2813, 0.1062, 0.0067, 0.2302, 0.0484, -0.0026, -0.0130, -0.0325, 0.0060}}};
constexpr Fit cividis{{{0.4868, 0.5225, -0.0016, -0.0006, 0.0151, -0.0283, 0.0195, -0.0183, -0.0199},
                       {0.5031, 0.3911, 0.0190, 0.0038, 0.0004, -0.0006, 0.0003, -0.0001, -0.0015},
                       {0.3879, -0.0293, -0.0837, -0.0099, -0.0183, 0.0217, -0.0121, 0.0087, 0.0089}}};

/// Clenshaw's recurrence.
double evaluate(const std::array<double, terms>& c, double x) {
  double b1 = 0, b2 = 0;
  for (std::size_t k = terms - 1; k > 0; --k) {
    const double b0 = 2 * x * b1 - b2 + c[k];
    b2 = b1, b1 = b0;
  }
  return x * b1 - b2 + c[0];
}

/// Straight lines in OKLab from white at 1/2 to a blue and a red of the same lightness and chroma.
Rgb8 diverging(double t) {
  const double part = std::fabs(2 * t - 1), hue = t < 0.5 ? 4.40 : 0.55;  // [rad]
  const double lightness = 0.97 - 0.50 * part, a = 0.155 * part * std::cos(hue), b = 0.155 * part * std::sin(hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3),
               m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3),
               s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return encode_srgb(Rgb{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s, -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                         -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s});
}

std::uint8_t code(double v) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
}

}  // namespace

const std::vector<std::string>& color_map_names() {
  static const std::vector<std::string> names{"viridis", "magma", "inferno", "cividis", "grey", "difference"};
  return names;
}

ColorMap color_map_from_name(const std::string& name) {
  const auto& names = color_map_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<ColorMap>(at - names.begin());
  const std::string nearest = nearest_name(name, names);
  throw UsageError("--colormap: found '" + name + "'; expected one of " + joined(names) +
                   (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}

Rgb8 color_at(ColorMap map, double t) {
  if (std::isnan(t)) return {128, 128, 128};
  t = std::clamp(t, 0.0, 1.0);
  if (map == ColorMap::grey) return {code(t), code(t), code(t)};
  if (map == ColorMap::difference) return diverging(t);
  const Fit& fit = map == ColorMap::viridis ? viridis : map == ColorMap::magma ? magma : map == ColorMap::inferno ? inferno : cividis;
  const double x = 2 * t - 1;
  return {code(evaluate(fit[0], x)), code(evaluate(fit[1], x)), code(evaluate(fit[2], x))};
}

Rgb8 category_color(std::size_t k) {
  constexpr std::array<Rgb8, 8> fixed{
      {{0, 158, 115}, {213, 94, 0}, {0, 114, 178}, {230, 159, 0}, {204, 121, 167}, {86, 180, 233}, {240, 228, 66}, {90, 90, 90}}};
  if (k < fixed.size()) return fixed[k];
  // HSL with the hue turned by the golden angle, so that neighbours in a list never look alike.
  const double hue = std::fmod(static_cast<double>(k) * 137.50776405003785, 360.0) / 60.0;
  const double lightness = std::array{0.42, 0.55, 0.68}[k % 3], chroma = (1 - std::fabs(2 * lightness - 1)) * 0.7;
  const double x = chroma * (1 - std::fabs(std::fmod(hue, 2.0) - 1)), low = lightness - chroma / 2;
  const std::array<std::array<double, 3>, 6> sectors{
      {{chroma, x, 0}, {x, chroma, 0}, {0, chroma, x}, {0, x, chroma}, {x, 0, chroma}, {chroma, 0, x}}};
  const auto& s = sectors[std::min<std::size_t>(5, static_cast<std::size_t>(hue))];
  return {code(s[0] + low), code(s[1] + low), code(s[2] + low)};
}

}  // namespace sunfleck
