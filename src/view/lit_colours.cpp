#include "view/lit_colours.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

constexpr std::size_t coloured_at_once = std::size_t{1} << 16;
constexpr std::size_t most_samples = 1000000;  // facets that set exposure or scale; every k-th of more

}  // namespace

const std::vector<std::string>& mesh_quantities() {
  static const std::vector<std::string> names{"absorbed", "irradiance_front", "irradiance_back", "sunlit_front", "sunlit_back", "type",
                                              "optics"};
  return names;
}

LitColours::LitColours(const Result& result, const ResultGeometry& geometry, const MeshChoice& choice, Progress& progress)
    : result_(result),
      geometry_(geometry),
      choice_(choice),
      state_(choice.state.value_or(0)),
      natural_(choice.quantity == "colour"),
      named_(choice.quantity == "type" || choice.quantity == "optics"),
      quantity_(choice.quantity),
      materials_(result.materials()) {
  const auto& known = mesh_quantities();
  if (!natural_ && std::find(known.begin(), known.end(), quantity_) == known.end()) {
    const std::string nearest = nearest_name(quantity_, known);
    throw UsageError(fmt::format("--quantity: found '{}'; expected colour, {}{}", quantity_, joined(known),
                                 nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
  }
  if (natural_ && !result.has("facets/irradiance")) natural_ = false, quantity_ = "absorbed";
  if (natural_) {
    quantity_ = "absorbed";
    bands_ = colour_bands(result.bands());
    for (const auto& material : materials_) {
      auto& row = surfaces_.emplace_back();
      for (const auto& type : geometry.types()) row.push_back(surface_of(type, material.name));
    }
  }
  if (named_) {
    if (quantity_ == "type") names_ = geometry.types();
    if (quantity_ == "optics")
      for (const auto& material : materials_) names_.push_back(material.name);
    if (quantity_ == "type") names_.push_back("ground");
    return;
  }
  const std::size_t n = geometry.facet_count(), step = n / most_samples + 1;
  std::vector<float> luminances;
  std::vector<double> numbers;
  for (std::size_t first = 0; first < n; first += coloured_at_once) {
    progress.check();
    const std::size_t count = std::min(coloured_at_once, n - first), start = (step - first % step) % step;
    if (natural_) {
      const auto colours = light(first, count);
      for (std::size_t i = start; i < count; i += step) luminances.push_back(luminance(colours[i]));
    } else if (first < geometry.plant_facets || geometry.plant_facets == 0) {
      const auto row = values(first, count);
      for (std::size_t i = start; i < count; i += step) numbers.push_back(row[i]);
    }
  }
  if (natural_)
    exposure_ = exposure_for(std::move(luminances));
  else
    scale_ = scale_for(std::move(numbers), false);
}

std::vector<float> LitColours::values(std::size_t first, std::size_t count) const {
  const std::size_t bands = result_.bands().size();
  std::vector<float> out(count, 0.0f);
  const auto pick = [&](const char* dataset, std::size_t width, std::size_t column) {
    if (natural_ && !result_.has(dataset)) return;
    const auto rows = result_.state_rows<float>(dataset, state_, first, count);
    for (std::size_t i = 0; i < count; ++i) out[i] = rows[i * width + column];
  };
  if (quantity_ == "absorbed") pick("facets/absorbed", bands, choice_.band);
  if (quantity_ == "irradiance_front") pick("facets/irradiance", 2 * bands, choice_.band);
  if (quantity_ == "irradiance_back") pick("facets/irradiance", 2 * bands, bands + choice_.band);
  const auto row_numbers = [&](const std::vector<std::uint32_t>& rows) {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(std::min<std::size_t>(rows[i], names_.size() - 1));
  };
  if (quantity_ == "type") row_numbers(geometry_.types_of(first, count));
  if (quantity_ == "optics") row_numbers(geometry_.optics(first, count));
  if (quantity_ == "sunlit_front") pick("facets/sunlit", 2, 0);
  if (quantity_ == "sunlit_back") pick("facets/sunlit", 2, 1);
  return out;
}

std::vector<Rgb> LitColours::light(std::size_t first, std::size_t count) const {
  const std::size_t bands = result_.bands().size();
  const auto irradiance = result_.state_rows<float>("facets/irradiance", state_, first, count);
  const auto optics = geometry_.optics(first, count), type = geometry_.types_of(first, count);
  std::vector<Rgb> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const SurfaceKind surface = first + i >= geometry_.plant_facets ? SurfaceKind::soil : surfaces_[optics[i]][type[i]];
    const float* e = &irradiance[2 * i * bands];
    out[i] = 0.5f * (facet_colour(bands_, materials_[optics[i]], surface, e, Side::front) +
                     facet_colour(bands_, materials_[optics[i]], surface, e, Side::back));
  }
  return out;
}

std::string LitColours::unit() const {
  if (named_) return "row";
  return quantity_.rfind("sunlit", 0) == 0 ? "1" : result_.band_units()[choice_.band];
}

std::vector<float> LitColours::shades(std::size_t first, std::size_t count) const {
  auto numbers = values(first, count);
  if (!natural_) return numbers;
  const auto colours = light(first, count);
  std::vector<float> out(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) out[4 * i + static_cast<std::size_t>(c)] = colours[i][c];
    out[4 * i + 3] = numbers[i];
  }
  return out;
}

Rgb8 LitColours::colour(const float* shade) const {
  if (natural_) return encode_srgb(tone_map(Rgb{shade[0], shade[1], shade[2]}, exposure_));
  if (named_) return category_color(static_cast<std::size_t>(shade[0] + 0.5f));
  return color_at(choice_.map, scale_.position(shade[0]));
}

LitColours::Range LitColours::range(std::size_t first, std::size_t count) const {
  Range out{std::vector<Rgb8>(count), std::vector<float>(count)};
  const auto all = shades(first, count);
  const std::size_t w = width();
  for (std::size_t i = 0; i < count; ++i) {
    out.colours[i] = colour(&all[w * i]);
    out.values[i] = all[w * i + w - 1];
  }
  return out;
}

}  // namespace sunfleck
