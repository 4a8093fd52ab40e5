#include "view/viewer_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

/// A quoted field where RFC 4180 wants one.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string title_of(const SelectionStatistics& s) {
  std::string out = s.title.empty() ? std::string("value") : s.title.front();
  if (s.title.size() > 1) out += " [" + s.title.back() + "]";
  return out;
}

std::size_t bin_of(double value, double low, double high, std::size_t bins) {
  if (!(high > low)) return 0;
  return static_cast<std::size_t>(std::clamp((value - low) / (high - low) * static_cast<double>(bins), 0.0, static_cast<double>(bins - 1)));
}

std::vector<double> edges(double low, double high, std::size_t bins) {
  std::vector<double> out;
  for (std::size_t i = 0; i <= bins; ++i) out.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(bins));
  return out;
}

}  // namespace

SelectionStatistics selection_statistics(const ViewerScenes& scenes, std::size_t result, const ShownQuantity& shown,
                                         const std::string& selection, std::size_t bins, std::size_t layers) {
  const ViewerScene& viewed = *scenes.at(result);
  const FacetScene& scene = viewed.scene();
  const auto kept = [&](const char* quantity) {
    return std::find(viewed.quantities().begin(), viewed.quantities().end(), quantity) != viewed.quantities().end();
  };
  ShownQuantity counted = shown;
  if (shown.quantity == "colour") counted.quantity = kept("absorbed") ? "absorbed" : "area";
  const ShownMap values = shown_map(scenes, result, counted, false, std::nullopt);
  const FacetMap& map = values.map->map;
  const std::size_t sides = map.sides ? 2 : 1;

  SelectionStatistics out;
  out.title = map.title, out.categories = map.names;
  if (counted.difference) out.title.front() = "difference of " + out.title.front();
  const auto selected = selected_organs(scene, selection);
  std::vector<std::uint32_t> facets;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  out.low = lowest, out.high = highest;
  const auto centroid = [&](std::uint32_t f) { return (scene.corners[f][0].z + scene.corners[f][1].z + scene.corners[f][2].z) / 3; };
  double sum = 0;
  for (std::size_t o = 0; o < selected.size(); ++o) {
    if (!selected[o]) continue;
    ++out.organs;
    for (auto i = viewed.organ_first()[o]; i < viewed.organ_first()[o + 1]; ++i) {
      const auto f = viewed.organ_facets()[i];
      if (!(scene.area[f] > 0)) continue;
      facets.push_back(f);
      out.area += scene.area[f];
      lowest = std::min(lowest, centroid(f)), highest = std::max(highest, centroid(f));
      for (std::size_t s = 0; s < sides; ++s) {
        const double v = values.value(f, s == 0);
        out.low = std::min(out.low, v), out.high = std::max(out.high, v);
        sum += scene.area[f] * v / static_cast<double>(sides);
      }
    }
  }
  out.facets = facets.size();
  if (facets.empty()) {
    out.low = out.high = 0;
    return out;
  }
  const bool names = !out.categories.empty();
  out.mean = names ? 0 : sum / out.area;
  if (names) {
    bins = out.categories.size();
  } else {
    out.histogram_edge = edges(out.low, out.high > out.low ? out.high : out.low + 1, bins);
  }
  out.histogram_area.assign(bins, 0.0);
  out.height = edges(lowest, highest > lowest ? highest : lowest + 1e-3, layers);
  out.layer_area.assign(layers, 0.0), out.layer_mean.assign(layers, 0.0);
  std::vector<std::shared_ptr<const ViewerMap>> absorbed;
  if (!counted.difference && kept("absorbed"))
    for (std::size_t b = 0; b < viewed.bands().size(); ++b) {
      absorbed.push_back(viewed.map("absorbed", b, shown.state));
      out.bands.push_back(viewed.bands()[b]);
    }
  const std::size_t width = out.bands.size();
  out.layer_absorbed.assign(layers * width, 0.0), out.absorbed.assign(width, 0.0);
  double squares = 0;
  for (const auto f : facets) {
    const double area = scene.area[f];
    const std::size_t layer = bin_of(centroid(f), lowest, highest, layers);
    out.layer_area[layer] += area;
    for (std::size_t s = 0; s < sides; ++s) {
      const double v = values.value(f, s == 0), share = area / static_cast<double>(sides);
      out.histogram_area[names ? std::min(static_cast<std::size_t>(v), bins - 1) : bin_of(v, out.low, out.high, bins)] += share;
      out.layer_mean[layer] += share * v;
      squares += share * (v - out.mean) * (v - out.mean);
    }
    for (std::size_t b = 0; b < width; ++b) {
      const double power = area * static_cast<double>(absorbed[b]->map.values[f]);
      out.layer_absorbed[layer * width + b] += power, out.absorbed[b] += power;
    }
  }
  out.deviation = names ? 0 : std::sqrt(squares / out.area);
  for (std::size_t l = 0; l < layers; ++l)
    out.layer_mean[l] = out.layer_area[l] > 0 ? out.layer_mean[l] / out.layer_area[l] : std::numeric_limits<double>::quiet_NaN();
  if (!names) return out;
  out.layer_mean.clear(), out.low = out.high = 0;
  std::size_t used = 0;  // names that the selection does not have are left out
  for (std::size_t k = 0; k < bins; ++k)
    if (out.histogram_area[k] > 0) {
      out.categories[used] = out.categories[k];
      out.histogram_area[used++] = out.histogram_area[k];
    }
  out.categories.resize(used), out.histogram_area.resize(used);
  return out;
}

std::string histogram_csv(const SelectionStatistics& s) {
  std::string text;
  if (!s.categories.empty()) {
    text = field(title_of(s)) + ",area_m2\r\n";
    for (std::size_t i = 0; i < s.histogram_area.size(); ++i) text += fmt::format("{},{}\r\n", field(s.categories[i]), s.histogram_area[i]);
    return text;
  }
  text = fmt::format("{},{},area_m2\r\n", field("from " + title_of(s)), field("to " + title_of(s)));
  for (std::size_t i = 0; i < s.histogram_area.size(); ++i)
    text += fmt::format("{},{},{}\r\n", s.histogram_edge[i], s.histogram_edge[i + 1], s.histogram_area[i]);
  return text;
}

std::string profile_csv(const SelectionStatistics& s) {
  std::string text = "height_from_m,height_to_m,area_m2";
  if (!s.layer_mean.empty()) text += "," + field("mean " + title_of(s));
  for (const auto& band : s.bands) text += "," + field("absorbed_W_" + band);
  text += "\r\n";
  for (std::size_t l = 0; l < s.layer_area.size(); ++l) {
    text += fmt::format("{},{},{}", s.height[l], s.height[l + 1], s.layer_area[l]);
    if (!s.layer_mean.empty()) text += s.layer_area[l] > 0 ? fmt::format(",{}", s.layer_mean[l]) : std::string(",");
    for (std::size_t b = 0; b < s.bands.size(); ++b) text += fmt::format(",{}", s.layer_absorbed[l * s.bands.size() + b]);
    text += "\r\n";
  }
  return text;
}

}  // namespace sunfleck
