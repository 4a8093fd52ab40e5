#include "view/viewer_answers.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>
#include <sunfleck/core/version.hpp>
#include <sunfleck/view/text.hpp>

#include "view/lower_case.hpp"

namespace sunfleck {

namespace {

using nlohmann::json;

std::string css(const Rgb8& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

std::vector<std::string> pretty_units(const ViewerScene& scene) {
  std::vector<std::string> out;
  for (const auto& unit : scene.units()) out.push_back(pretty_unit(unit));
  return out;
}

json point(const Vec3& p) {
  return {p.x, p.y, p.z};
}

/// Box of the organ's facets.
Box organ_box(const ViewerScene& scene, std::size_t organ) {
  Box box;
  for (auto i = scene.organ_first()[organ]; i < scene.organ_first()[organ + 1]; ++i)
    for (const auto& p : scene.scene().corners[scene.organ_facets()[i]]) box.add(p);
  return box;
}

json organ_names(const ViewerScene& scene, std::size_t organ) {
  const auto& organs = scene.scene().organs;
  return {{"organ", organ},
          {"name", organs.names[organs.name[organ]]},
          {"type", organs.types[organs.type[organ]]},
          {"plant", organs.plants[organs.plant[organ]]},
          {"placement", organs.placements[organs.placement[organ]]},
          {"placement_row", organs.placement[organ]}};
}

/// Front, then back, per band.
json sides(const std::vector<float>& values, std::size_t bands) {
  const auto at = [&](std::size_t side) {
    return json(std::vector<float>(values.begin() + static_cast<std::ptrdiff_t>(side * bands),
                                   values.begin() + static_cast<std::ptrdiff_t>((side + 1) * bands)));
  };
  return {{"front", at(0)}, {"back", at(1)}};
}

}  // namespace

json describe(const ViewerScenes& scenes) {
  json out;
  out["version"] = software_version();
  out["maps"] = color_map_names();
  for (const auto& scene : scenes) {
    const auto& facets = scene->scene();
    json one{{"file", scene->file()},
             {"method", scene->header().method},
             {"status", scene->header().status},
             {"scene_file", scene->header().scene_file},
             {"bands", scene->bands()},
             {"units", pretty_units(*scene)},
             {"quantities", scene->quantities()},
             {"types", facets.organs.types},
             {"facets", facets.size()},
             {"organs", facets.organs.size()},
             {"ground", facets.plant_facets < facets.size()},
             {"periodic", facets.periodic.has_value()},
             {"low", point(facets.bounds.low)},
             {"high", point(facets.bounds.high)}};
    for (const auto& state : scene->states()) one["states"].push_back(state.name);
    const OrbitCamera usual;
    one["camera"] = {
        {"azimuth", usual.azimuth_deg},          {"elevation", usual.elevation_deg},         {"distance", scene->framing().by_height},
        {"by_width", scene->framing().by_width}, {"target", point(scene->framing().target)}, {"fov", usual.field_of_view_deg}};
    out["results"].push_back(std::move(one));
  }
  out["difference"] = false;
  if (scenes.size() == 2) {
    const SceneMatch match = scenes[0]->match(*scenes[1]);
    out["difference"] = !match.difference;
    out["notes"] = match.notes;
    if (match.difference)
      out["notes"].push_back(fmt::format("they are not of the same scene: {} in the first, {} in the second", match.difference->found,
                                         match.difference->expected));
  }
  return out;
}

json placements(const ViewerScene& scene, const std::string& text, std::size_t most) {
  const auto& organs = scene.scene().organs;
  const std::size_t count = organs.placements.size();
  std::vector<std::size_t> number(count, 0);
  std::vector<double> area(count, 0.0);
  std::vector<std::uint32_t> plant(count, 0);
  for (std::size_t o = 0; o < organs.size(); ++o) {
    const auto p = organs.placement[o];
    ++number[p], plant[p] = organs.plant[o], area[p] += scene.organ_area(o);
  }
  const std::string wanted = lower_case(text);
  json rows = json::array();
  std::size_t total = 0;
  for (std::size_t p = 0; p < count; ++p) {
    if (number[p] == 0 || lower_case(organs.placements[p]).find(wanted) == std::string::npos) continue;
    ++total;
    if (rows.size() < most)
      rows.push_back(
          {{"row", p}, {"name", organs.placements[p]}, {"plant", organs.plants[plant[p]]}, {"organs", number[p]}, {"area", area[p]}});
  }
  return {{"total", total}, {"placements", std::move(rows)}};
}

json organ_numbers(const ViewerScene& scene, std::size_t organ, std::uint32_t facet, std::size_t state) {
  json out = organ_names(scene, organ);
  const std::size_t bands = scene.bands().size();
  out["bands"] = scene.bands(), out["units"] = pretty_units(scene);
  out["facets"] = scene.organ_first()[organ + 1] - scene.organ_first()[organ];
  const float area = scene.organ_area(organ);
  out["area"] = area;
  const Box box = organ_box(scene, organ);
  if (!box.empty()) out["low"] = point(box.low), out["high"] = point(box.high);
  if (const auto absorbed = scene.row("organs/absorbed", state, organ); absorbed.size() == bands) {
    out["absorbed"] = absorbed;
    for (const float power : absorbed) out["absorbed_per_area"].push_back(area > 0 ? power / area : 0.0f);
  }
  if (const auto e = scene.row("organs/irradiance", state, organ); e.size() == 2 * bands) out["irradiance"] = sides(e, bands);
  if (const auto lit = scene.row("organs/sunlit", state, organ); lit.size() == 2) out["sunlit"] = {{"front", lit[0]}, {"back", lit[1]}};
  if (facet == no_facet) return out;
  json one{{"row", facet}, {"area", scene.scene().area[facet]}};
  if (const auto absorbed = scene.row("facets/absorbed", state, facet); absorbed.size() == bands) one["absorbed"] = absorbed;
  if (const auto e = scene.row("facets/irradiance", state, facet); e.size() == 2 * bands) one["irradiance"] = sides(e, bands);
  if (const auto lit = scene.row("facets/sunlit", state, facet); lit.size() == 2) one["sunlit"] = {{"front", lit[0]}, {"back", lit[1]}};
  out["facet"] = std::move(one);
  return out;
}

json pick(const ViewerScenes& scenes, const ViewerView& view, double x, double y) {
  const ViewerScene& scene = *scenes.at(view.result);
  scene.wait_for_exact();
  const ViewerShader shader(scenes, view, true);
  const CameraRay ray = camera_of(view.camera, static_cast<double>(view.width) / view.height).ray(x, y);
  const RayHit hit = shader.first_shown(ray);
  if (!hit) return {{"organ", nullptr}};
  json out = organ_numbers(scene, scene.scene().organ[hit.facet], hit.facet, view.shown.state);
  out["side"] = hit.front ? "front" : "back";
  out["point"] = point(ray.origin + hit.distance * ray.direction);
  if (view.shown.quantity != "colour" && shader.shown().map->map.names.empty()) out["value"] = shader.shown().value(hit.facet, hit.front);
  return out;
}

json search_organs(const ViewerScene& scene, const std::string& text, std::size_t most) {
  const auto& organs = scene.scene().organs;
  const std::string wanted = lower_case(text);
  // Names are few where organs are many: each is compared once.
  std::vector<std::string> names, placements;
  std::vector<std::uint8_t> match;
  for (const auto& name : organs.names) {
    names.push_back(lower_case(name));
    match.push_back(names.back().starts_with(wanted) ? 2 : names.back().find(wanted) != std::string::npos ? 1 : 0);
  }
  for (const auto& placement : organs.placements) placements.push_back(lower_case(placement));
  std::size_t total = 0;
  std::vector<std::size_t> first, second;
  const bool path = wanted.find('/') != std::string::npos || wanted.find('[') != std::string::npos;
  for (std::size_t o = 0; o < organs.size() && !wanted.empty(); ++o) {
    const auto kind = match[organs.name[o]];
    const bool found =
        kind > 0 || (path && (placements[organs.placement[o]] + "/" + names[organs.name[o]]).find(wanted) != std::string::npos);
    if (!found) continue;
    ++total;
    auto& list = kind == 2 ? first : second;
    if (list.size() < most) list.push_back(o);
  }
  json rows = json::array();
  for (const auto* list : {&first, &second})
    for (const auto o : *list)
      if (rows.size() < most) rows.push_back(organ_names(scene, o));
  return {{"total", total}, {"organs", std::move(rows)}};
}

json legend(const ViewerScenes& scenes, const ViewerView& view) {
  if (view.shown.quantity == "colour") return {{"kind", "colour"}};
  const ShownMap shown = shown_map(scenes, view.result, view.shown, view.logarithmic, view.range);
  const FacetMap& map = shown.map->map;
  json out{{"title", map.title}};
  if (view.shown.difference) out["title"][0] = "difference of " + map.title.front();
  if (!map.names.empty()) {
    const auto& facets = scenes[view.result]->scene();
    const std::size_t end = view.map_ground || facets.plant_facets == 0 ? facets.size() : facets.plant_facets;
    std::vector<std::uint8_t> used(map.names.size(), 0);
    for (std::size_t f = 0; f < end; ++f)
      if (const auto row = static_cast<std::size_t>(map.values[f]); row < used.size()) used[row] = 1;
    out["kind"] = "names", out["names"] = json::array(), out["colours"] = json::array();
    for (std::size_t k = 0; k < used.size(); ++k)
      if (used[k]) out["names"].push_back(map.names[k]), out["colours"].push_back(css(category_color(k)));
    return out;
  }
  out["kind"] = "numbers";
  out["low"] = shown.scale.low, out["high"] = shown.scale.high, out["log"] = shown.scale.logarithmic;
  for (const auto& tick : nice_ticks(shown.scale))
    out["ticks"].push_back({{"label", tick.label}, {"at", shown.scale.position(tick.value)}});
  for (int k = 0; k <= 32; ++k) out["colours"].push_back(css(shown.diverging ? difference_color(k / 32.0) : color_at(view.map, k / 32.0)));
  return out;
}

json statistics_json(const SelectionStatistics& s) {
  json out{{"title", s.title},
           {"organs", s.organs},
           {"facets", s.facets},
           {"area", s.area},
           {"mean", s.mean},
           {"deviation", s.deviation},
           {"low", s.low},
           {"high", s.high},
           {"bands", s.bands},
           {"absorbed", s.absorbed},
           {"categories", s.categories},
           {"histogram", {{"edges", s.histogram_edge}, {"area", s.histogram_area}}},
           {"profile", {{"height", s.height}, {"area", s.layer_area}, {"absorbed", s.layer_absorbed}, {"mean", json::array()}}}};
  for (const double mean : s.layer_mean) out["profile"]["mean"].push_back(std::isfinite(mean) ? json(mean) : json(nullptr));
  return out;
}

}  // namespace sunfleck
