#include "view/viewer_view.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/names.hpp>

namespace sunfleck {

namespace {

constexpr int most_pixels = 8'000'000;
constexpr double beyond_all = 1e12;  ///< [m]

[[noreturn]] void refuse(const std::string& name, const std::string& found, const std::string& expected) {
  throw UsageError(fmt::format("{}: found '{}'; expected {}", name, found.substr(0, 80), expected));
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<double> numbers(const std::string& name, const std::string& text, std::size_t count) {
  std::vector<double> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto value = number(std::string_view(text).substr(at, comma - at));
    if (!value || std::fabs(*value) > beyond_all) break;
    out.push_back(*value);
    at = comma + 1;
    if (comma == text.size()) break;
  }
  if (out.size() != count || static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1 != count)
    refuse(name, text, fmt::format("{} finite numbers with commas between", count));
  return out;
}

std::size_t row_of(const std::string& name, const std::string& text, std::size_t end) {
  std::size_t row = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), row);
  if (error != std::errc{} || at != text.data() + text.size() || row >= end) refuse(name, text, fmt::format("a row below {}", end));
  return row;
}

/// Sets the rows named by "0-3,7".
std::vector<std::uint8_t> rows_of(const std::string& name, std::string_view text, std::size_t count) {
  std::vector<std::uint8_t> chosen(count, 0);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto part = text.substr(at, comma - at);
    const std::size_t dash = part.find('-');
    const std::size_t first = row_of(name, std::string(part.substr(0, dash)), count),
                      last = dash == std::string_view::npos ? first : row_of(name, std::string(part.substr(dash + 1)), count);
    for (std::size_t i = first; i <= last; ++i) chosen[i] = 1;
    at = comma + 1;
  }
  return chosen;
}

Vec3 outward(const OrbitCamera& c) {
  const double a = c.azimuth_deg * std::numbers::pi / 180, e = c.elevation_deg * std::numbers::pi / 180;
  return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

}  // namespace

double read_number(const Parameters& parameters, const std::string& name, double fallback, double low, double high) {
  const auto text = parameters(name);
  if (!text) return fallback;
  const auto value = number(*text);
  if (!value || *value < low || *value > high) refuse(name, *text, fmt::format("a number from {:g} to {:g}", low, high));
  return *value;
}

std::size_t read_count(const Parameters& parameters, const std::string& name, std::size_t fallback, std::size_t low, std::size_t high) {
  const auto text = parameters(name);
  if (!text) return fallback;
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || end != text->data() + text->size() || value < low || value > high)
    refuse(name, *text, fmt::format("a whole number from {} to {}", low, high));
  return value;
}

bool read_flag(const Parameters& parameters, const std::string& name, bool fallback) {
  const auto text = parameters(name);
  if (!text) return fallback;
  if (*text != "0" && *text != "1") refuse(name, *text, "0 or 1");
  return *text == "1";
}

ShownQuantity read_quantity(const Parameters& parameters, const ViewerScenes& scenes, std::size_t result) {
  const ViewerScene& scene = *scenes.at(result);
  ShownQuantity q;
  q.quantity = parameters("quantity").value_or("colour");
  if (q.quantity != "colour" || !parameters("quantity")) {
    const auto& known = scene.quantities();
    if (std::find(known.begin(), known.end(), q.quantity) == known.end()) refuse("quantity", q.quantity, "one of " + joined(known));
  }
  q.band = read_count(parameters, "band", 0, 0, scene.bands().size() - 1);
  q.state = read_count(parameters, "state", 0, 0, scene.states().size() - 1);
  q.difference = read_flag(parameters, "difference", false);
  if (q.difference) {
    if (scenes.size() != 2) refuse("difference", "1", "0; only one result is open");
    if (q.quantity == "colour") refuse("quantity", q.quantity, "a number; a difference has no natural colour");
    const auto& other = *scenes[1];
    const auto& known = other.quantities();
    if (scenes[0]->match(other).difference) refuse("difference", "1", "0; the results are not of the same scene");
    if (std::find(known.begin(), known.end(), q.quantity) == known.end() || q.band >= other.bands().size() ||
        q.state >= other.states().size())
      refuse("difference", "1", "a quantity, band and state that both results hold");
  }
  return q;
}

ViewerView read_view(const Parameters& parameters, const ViewerScenes& scenes) {
  ViewerView v;
  v.result = read_count(parameters, "result", 0, 0, scenes.size() - 1);
  v.shown = read_quantity(parameters, scenes, v.result);
  if (v.shown.difference) v.result = 0;
  if (const auto name = parameters("map")) v.map = color_map_from_name(*name);
  v.logarithmic = read_flag(parameters, "log", false);
  if (const auto text = parameters("range")) {
    const auto ends = numbers("range", *text, 2);
    if (!(ends[0] < ends[1])) refuse("range", *text, "the lower number first");
    if (v.logarithmic && !(ends[0] > 0)) refuse("range", *text, "numbers above zero on a logarithmic scale");
    v.range = {ends[0], ends[1]};
  }
  v.camera.azimuth_deg = read_number(parameters, "azimuth", 150, -1e6, 1e6);
  v.camera.elevation_deg = read_number(parameters, "elevation", 25, -89.9, 89.9);
  v.camera.distance = read_number(parameters, "distance", 1, 1e-9, beyond_all);
  v.camera.field_of_view_deg = read_number(parameters, "fov", 35, 1, 120);
  v.camera.orthographic = read_flag(parameters, "orthographic", false);
  if (const auto text = parameters("target")) {
    const auto p = numbers("target", *text, 3);
    v.camera.target = {p[0], p[1], p[2]};
  }
  if (const auto text = parameters("cut")) {
    const auto p = numbers("cut", *text, 4);
    const Vec3 normal{p[0], p[1], p[2]};
    if (!(glm::length(normal) > 1e-6)) refuse("cut", *text, "a normal that is not zero, and an offset");
    v.cut = CutPlane{normal / glm::length(normal), p[3] / glm::length(normal)};
  }
  v.selection = parameters("select").value_or("");
  v.only_selected = read_flag(parameters, "only", false);
  v.ground = read_flag(parameters, "ground", true);
  v.map_ground = read_flag(parameters, "map_ground", false);
  v.infinite = read_flag(parameters, "infinite", false);
  v.dark = read_flag(parameters, "dark", false);
  v.exposure_stops = read_number(parameters, "exposure", 0, -10, 10);
  if (const auto text = parameters("highlight"))
    v.highlight = static_cast<std::uint32_t>(row_of("highlight", *text, scenes[v.result]->scene().organs.size()));
  v.width = static_cast<int>(read_count(parameters, "width", 640, 16, 8192));
  v.height = static_cast<int>(read_count(parameters, "height", 480, 16, 8192));
  if (v.width * v.height > most_pixels) refuse("width", std::to_string(v.width), fmt::format("at most {} pixels in all", most_pixels));
  return v;
}

std::string ViewerView::key() const {
  std::string text = fmt::format("{} {} {} {} {} {} {} {}x{}", result, shown.quantity, shown.band, shown.state, shown.difference,
                                 static_cast<int>(map), logarithmic, width, height);
  if (range) text += fmt::format(" r{} {}", (*range)[0], (*range)[1]);
  const auto& c = camera;
  text += fmt::format(" c{} {} {} {} {} {} {} {}", c.azimuth_deg, c.elevation_deg, c.distance, c.target.x, c.target.y, c.target.z,
                      c.field_of_view_deg, c.orthographic);
  if (cut) text += fmt::format(" p{} {} {} {}", cut->normal.x, cut->normal.y, cut->normal.z, cut->offset);
  text += fmt::format(" {}{}{}{}{} {} s", only_selected, ground, map_ground, infinite, dark, exposure_stops);
  return text + selection;
}

Camera camera_of(const OrbitCamera& orbit, double aspect) {
  const Vec3 out = outward(orbit);
  const double half = orbit.distance * std::tan(0.5 * orbit.field_of_view_deg * std::numbers::pi / 180);
  CameraChoice choice;
  choice.target = orbit.target;
  choice.field_of_view_deg = orbit.field_of_view_deg;
  choice.orthographic = orbit.orthographic;
  // A parallel camera stands far behind its picture, so that nothing lies behind it.
  choice.eye = orbit.target + (orbit.orthographic ? 1e3 * orbit.distance : orbit.distance) * out;
  const Vec3 up = glm::normalize(glm::cross(glm::cross(-out, Vec3{0, 0, 1}), -out));
  const std::array<Vec3, 1> top{orbit.target + half * up};
  return Camera(choice, top, aspect, {.left = 0, .right = 1, .top = 0, .bottom = 1});
}

std::vector<std::uint8_t> selected_organs(const FacetScene& scene, const std::string& selection) {
  const auto& organs = scene.organs;
  std::vector<std::uint8_t> chosen(organs.size(), 1);
  bool ground = false;  // named by a selection of its own, never by "everything"
  for (std::size_t at = 0; at < selection.size();) {
    const std::size_t end = std::min(selection.find(';', at), selection.size()), colon = selection.find(':', at);
    const std::string part = selection.substr(at, end - at);
    if (colon >= end) refuse("select", part, "placement:, plant:, type: or organ: and rows");
    const std::string kind = selection.substr(at, colon - at);
    const auto text = std::string_view(selection).substr(colon + 1, end - colon - 1);
    const auto narrow = [&](const std::vector<std::uint32_t>* row, std::size_t count) {
      const auto named = rows_of("select", text, count);
      for (std::size_t o = 0; o < chosen.size(); ++o) chosen[o] &= named[row ? (*row)[o] : o];
    };
    if (kind == "placement")
      narrow(&organs.placement, organs.placements.size());
    else if (kind == "plant")
      narrow(&organs.plant, organs.plants.size());
    else if (kind == "type")
      narrow(&organs.type, organs.types.size());
    else if (kind == "organ")
      narrow(nullptr, organs.size());
    else
      refuse("select", part, "placement:, plant:, type: or organ: and rows");
    ground = true;
    at = end + 1;
  }
  if (!ground && scene.plant_facets > 0)
    for (std::size_t f = scene.plant_facets; f < scene.size(); ++f) chosen[scene.organ[f]] = 0;
  return chosen;
}

}  // namespace sunfleck
