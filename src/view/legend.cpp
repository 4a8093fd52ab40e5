#include <sunfleck/view/legend.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace sunfleck {

namespace {

constexpr Rgb8 ink{40, 40, 40};

double percentile(std::vector<double>& values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::llround(static_cast<double>(values.size() - 1) * fraction));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::string label(double value, double step) {
  if (value != 0 && (std::fabs(value) >= 1e5 || std::fabs(value) < 1e-3)) return fmt::format("{:.6g}", value);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  return fmt::format("{:.{}f}", value, decimals);
}

int draw_title(Image& image, const Font& font, const LegendPlace& place, const std::vector<std::string>& title) {
  double y = place.top + place.size;
  for (const auto& line : title) {
    double size = place.size;
    while (size > 8 && font.width(line, size) > place.width) size *= 0.95;
    font.draw(image, place.left, y, line, size, ink);
    y += 1.25 * place.size;
  }
  return static_cast<int>(y - 0.3 * place.size);
}

}  // namespace

double ValueScale::position(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  if (!(value > 0)) return -std::numeric_limits<double>::infinity();
  return std::log(value / low) / std::log(high / low);
}

ValueScale scale_for(std::vector<double> values, bool logarithmic) {
  values.erase(std::remove_if(values.begin(), values.end(), [&](double v) { return !std::isfinite(v) || (logarithmic && !(v > 0)); }),
               values.end());
  ValueScale scale{logarithmic ? 0.1 : 0.0, 1.0, logarithmic};
  if (values.empty()) return scale;
  scale.low = percentile(values, 0.01), scale.high = percentile(values, 0.99);
  if (!(scale.high > scale.low))
    scale.low = *std::min_element(values.begin(), values.end()), scale.high = *std::max_element(values.begin(), values.end());
  if (logarithmic) {
    scale.low = std::max(scale.low, scale.high * 1e-4);
    if (!(scale.high > scale.low * 1.0001)) scale.low *= 0.5, scale.high *= 2;
    return scale;
  }
  if (scale.low > 0 && scale.low < 0.25 * scale.high) scale.low = 0;
  if (!(scale.high > scale.low)) {
    const double half = scale.high == 0 ? 1.0 : 0.5 * std::fabs(scale.high);
    scale.low -= scale.high == 0 ? 0.0 : half, scale.high += half;
  }
  return scale;
}

std::vector<Tick> nice_ticks(const ValueScale& scale, int wanted) {
  std::vector<Tick> ticks;
  if (scale.logarithmic && scale.high > 10 * scale.low) {
    const double decades = std::log10(scale.high / scale.low);
    const bool all = decades <= wanted / 3.0 + 0.5;
    for (int k = static_cast<int>(std::floor(std::log10(scale.low))); k <= static_cast<int>(std::ceil(std::log10(scale.high))); ++k)
      for (const int m : {1, 2, 5}) {
        const double v = m * std::pow(10.0, k);
        if ((m == 1 || all) && v >= scale.low * (1 - 1e-9) && v <= scale.high * (1 + 1e-9))
          ticks.push_back({v, label(v, std::pow(10.0, k))});
      }
    return ticks;
  }
  const double rough = (scale.high - scale.low) / std::max(1, wanted - 1), power = std::pow(10.0, std::floor(std::log10(rough))),
               f = rough / power;
  const double step = power * (f < 1.5 ? 1 : f < 3.5 ? 2 : f < 7.5 ? 5 : 10);
  const auto first = static_cast<long long>(std::ceil(scale.low / step - 1e-9)),
             last = static_cast<long long>(std::floor(scale.high / step + 1e-9));
  for (long long i = first; i <= last; ++i) ticks.push_back({static_cast<double>(i) * step, label(static_cast<double>(i) * step, step)});
  return ticks;
}

void draw_bar(Image& image, const Font& font, const LegendPlace& place, const std::vector<std::string>& title, ColorMap map,
              const ValueScale& scale, bool below, bool above) {
  const int title_end = draw_title(image, font, place, title);
  const int tip = static_cast<int>(place.size * 0.8), bar = static_cast<int>(place.size * 1.2);
  const int top = title_end + tip + 2, bottom = place.top + place.height - tip - static_cast<int>(0.5 * place.size), left = place.left;
  if (bottom - top < 10) return;
  for (int y = top; y < bottom; ++y) image.fill(left, y, left + bar, y + 1, color_at(map, 1.0 - (y + 0.5 - top) / (bottom - top)));
  for (int k = 0; k < tip; ++k) {
    const int inset = static_cast<int>(0.5 * bar * (k + 1) / tip);
    if (above) image.fill(left + inset, top - 1 - k, left + bar - inset, top - k, color_at(map, 1.0));
    if (below) image.fill(left + inset, bottom + k, left + bar - inset, bottom + k + 1, color_at(map, 0.0));
  }
  // At most one label every two lines of text.
  for (const auto& tick : nice_ticks(scale, std::max(2, static_cast<int>((bottom - top) / (2.4 * place.size))))) {
    const int y = static_cast<int>(std::lround(bottom - scale.position(tick.value) * (bottom - top)));
    image.fill(left + bar, y - 1, left + bar + static_cast<int>(0.35 * place.size), y + 1, ink);
    font.draw(image, left + bar + 0.55 * place.size, y + 0.32 * place.size, tick.label, place.size, ink);
  }
}

void draw_list(Image& image, const Font& font, const LegendPlace& place, const std::vector<std::string>& title,
               const std::vector<std::string>& names, const std::vector<Rgb8>& colours) {
  double y = draw_title(image, font, place, title) + 0.4 * place.size;
  const double step = 1.5 * place.size;
  const auto fits = static_cast<std::size_t>(std::max(1.0, (place.top + place.height - y) / step));
  const std::size_t shown = names.size() <= fits ? names.size() : fits - 1;
  const int square = static_cast<int>(place.size);
  for (std::size_t i = 0; i < shown; ++i, y += step) {
    image.fill(place.left, static_cast<int>(y), place.left + square, static_cast<int>(y) + square, colours[i]);
    double size = place.size;
    while (size > 8 && font.width(names[i], size) > place.width - 1.5 * square) size *= 0.95;
    font.draw(image, place.left + 1.5 * square, y + 0.82 * place.size, names[i], size, ink);
  }
  if (shown < names.size())
    font.draw(image, place.left, y + 0.82 * place.size, fmt::format("… and {} more", names.size() - shown), place.size, ink);
}

}  // namespace sunfleck
